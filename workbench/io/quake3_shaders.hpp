// Shader scripts of id Tech 3: what a surface's name means, as far as culling cares.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include <sightline/workbench/scene.hpp>

namespace sightline::io::quake3 {

/// Which faces a shader drops. Backs are those seen from where their triangles turn clockwise.
enum class Cull : std::uint8_t { backs, fronts, none };

struct ShaderLook {
  Surface surface = Surface::opaque;
  Cull cull = Cull::backs;
  std::string image = {};           ///< a cut-out's, without extension; empty: drawn whole
  std::uint8_t alpha_cutoff = 128;  ///< drawn where alpha >= this,
  bool inverted = false;            ///< of 255 - alpha
};

/// All scripts of a game. The first definition of a name counts.
class ShaderScripts {
public:
  /// Reads the scripts, first come first served. One whose braces do not match is left out as a whole, as the
  /// game does; so is one of more than kMaxScript bytes.
  explicit ShaderScripts(std::span<const std::string> scripts);

  /// By a surface's name in the level: upper and lower case are one, an extension is not looked at. Null
  /// where no script draws it.
  [[nodiscard]] const ShaderLook* find(std::string_view name) const;
  [[nodiscard]] std::size_t broken() const noexcept { return broken_; }
  [[nodiscard]] std::size_t size() const noexcept { return looks_.size(); }

  static constexpr std::size_t kMaxScript = std::size_t{8} << 20;

private:
  bool add(std::string_view script);

  std::map<std::string, ShaderLook, std::less<>> looks_;
  std::size_t broken_ = 0;
};

}  // namespace sightline::io::quake3
