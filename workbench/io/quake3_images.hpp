// The alpha that the images of a level's cut-outs have.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/io/alpha_png.hpp"
#include "workbench/io/quake3_shaders.hpp"

namespace sightline::io::quake3 {

/// Reads each image once, as a file of the game: .tga, else .jpg, which has no alpha, else .png, as the game
/// looks for them.
class LevelImages {
public:
  using GameFile = std::function<std::vector<std::byte>(const std::string& name)>;

  LevelImages(const GameFile& game_file, Scene& scene) : game_file_(game_file), scene_(scene) {}

  /// The scene's alpha image; kNoAlphaImage where there is none. One that cannot be read is said in
  /// Scene::ignored.
  std::uint32_t image_of(const ShaderLook& look);

private:
  std::uint32_t read(const std::string& name, bool inverted);

  const GameFile& game_file_;
  Scene& scene_;
  PixelBudget budget_;
  std::map<std::pair<std::string, bool>, std::uint32_t> known_;  ///< by name and whether it is inverted
};

}  // namespace sightline::io::quake3
