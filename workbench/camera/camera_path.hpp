// The camera's way through a scene: named paths that every scene has, or one from a file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <sightline/view.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline::camera {

struct CameraPath {
  std::string name;
  std::vector<Camera> cameras;
};

/// "walk" for a scene with a level, otherwise "near".
std::string_view default_path(const Scene& scene) noexcept;

/// `frames` cameras along "near", "far" (standing, turning gently), "rising" (from near up to far) or "walk"
/// (through the level from spawn point to spawn point; without a level, a circle at eye height); any other
/// name is a path file, of which at most `frames` views are taken (0: all). Throws Error for what is neither,
/// and where a path of the scene leads out of reach.
CameraPath make_path(const Scene& scene, const std::string& name_or_file, std::size_t frames);

}  // namespace sightline::camera
