// What rays against triangles lose, held against the item buffer on a scene's viewpoints and random views.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/measure/verify.hpp"
#include "workbench/report/table.hpp"

namespace sightline::reproduce {

struct RayScene {
  std::string scene;
  std::size_t views = 0;
  std::uint64_t pixels = 0;
  /// `guided`, summed over the views; the worst view's share of lost pixels; how many views exceed the
  /// target.
  std::uint64_t guided_lost = 0, guided_rays = 0;
  double guided_worst = 0, guided_ms = 0;
  std::size_t guided_over = 0;
  /// `triangle-pvs`: lost objects and pixels; the most pixels of a lost object; lost objects that cover a
  /// whole block of pixels as large as the spacing of the rays.
  std::uint64_t triangle_lost = 0, triangle_lost_pixels = 0, triangle_most = 0, triangle_covers = 0;
};

/// The image that the rays are held against: 100 × 100 rays stand 13 × 7 pixels apart, each in the middle of
/// a pixel, so that every block of 13 × 7 pixels has exactly one.
inline constexpr std::uint32_t kRaySceneWidth = 1300, kRaySceneHeight = 700, kRaySceneSide = 100;
inline constexpr double kGuidedTarget = 1e-4;

/// The scene's viewpoints, and random views until there are `views`.
RayScene measure_ray_scene(const Scene& scene, std::size_t views, const Progress& progress = {});
/// What each of the two lost.
report::Table guided_table(std::span<const RayScene> scenes);
report::Table triangle_pvs_table(std::span<const RayScene> scenes);

}  // namespace sightline::reproduce
