// The contract of all culling methods, and the registry that finds them. To add one: a file under methods/, a
// line in the registry.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include <sightline/result.hpp>
#include <sightline/view.hpp>
#include <sightline/workbench/frame.hpp>
#include <sightline/workbench/parameters.hpp>
#include <sightline/workbench/scene.hpp>
#include <sightline/workbench/triangle_draws.hpp>

namespace sightline {

enum class Guarantee : std::uint8_t {
  exact,         ///< the image equals the image drawn without culling
  conservative,  ///< never loses an object that has a visible pixel
  approximate,   ///< may lose something, so how much is always reported
};

std::string_view to_string(Guarantee guarantee) noexcept;

/// One culling method at work on one scene. The scene outlives the method.
class Method {
public:
  virtual ~Method() = default;
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  /// With the parameters it was made with.
  [[nodiscard]] virtual Guarantee guarantee() const noexcept = 0;
  /// Told after Scene::move_object of each of `objects`, before the next cull.
  virtual void update(std::span<const ObjectId> objects) = 0;
  /// Fills `frame` with what to draw. The view has passed check(). Same view and scene, and the same times
  /// told by took(), same answer, in the same order. Allocates nothing once frame and method have grown to
  /// their sizes.
  virtual void cull(const View& view, Frame& frame) noexcept = 0;
  /// Told, where the caller knows, what the last culled frame took from the beginning of culling to the
  /// finished picture: methods that choose among ways of drawing do so by it. Allocates nothing.
  virtual void took([[maybe_unused]] double milliseconds) noexcept {}
  /// The triangles that the frame's draws are ranges of, for a method that draws triangles instead of
  /// objects; null where draws are ranges of the scene's own meshes. Valid until update() or the method's
  /// end.
  [[nodiscard]] virtual const TriangleGeometry* geometry() const noexcept { return nullptr; }
};

struct MethodInfo {
  std::string_view name;
  std::string_view paper;    ///< where it was published
  std::string_view summary;  ///< what it does, one line
  Guarantee guarantee;       ///< with default parameters
  std::string_view needs;    ///< "" or what a scene must have, in words: "a level's PVS"
  std::span<const ParameterInfo> parameters;
  bool (*fits)(const Scene&);  ///< whether the scene has it
  Result<std::unique_ptr<Method>> (*create)(const Scene&, const Parameters&);
};

/// The CPU methods, in the order of the documentation.
std::span<const MethodInfo> cpu_methods() noexcept;

/// Finds by name; null where there is none.
const MethodInfo* find_method(std::string_view name) noexcept;

/// Makes a method from "NAME" or "NAME?key=value&…"; refuses unknown names, keys, values, an invalid scene,
/// or one that lacks what the method needs.
Result<std::unique_ptr<Method>> create_method(std::string_view specification, const Scene& scene);

}  // namespace sightline
