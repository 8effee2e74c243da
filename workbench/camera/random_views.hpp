// Seeded random cameras of the kinds that break culling.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/view.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline::camera {

/// Inside and around the scene, near its ground, at its viewpoints, within objects; in a level mostly in open
/// space. Any heading, pitch and roll, also along the axes; narrow and wide, orthographic, off-centre,
/// reversed, without a far plane. Same scene and seed, same cameras. Throws Error where the scene is too wide
/// for any view in single precision.
std::vector<Camera> random_cameras(const Scene& scene, std::size_t count, std::uint64_t seed);

}  // namespace sightline::camera
