// Ye et al. 2023: tables 4 and 6, figures 6, 11, 12 and 13 and the break-time, on five models of strata.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <sightline/workbench/progress.hpp>
#include <sightline/workbench/scene.hpp>

#include "workbench/device/frame_times.hpp"
#include "workbench/reproduce/ray_pvs/ray_scenes.hpp"
#include "workbench/reproduce/reproduction.hpp"
#include "workbench/scene/strata.hpp"

namespace sightline::reproduce {

/// The paper's five, and ours beside them.
inline constexpr std::array<const char*, 6> kRayMethods{"toca", "boca", "iwcpa",
                                                        "bvha", "saa",  "tuned-iwcpa"};
enum RayMethod : std::size_t { kToca, kBoca, kIwcpa, kBvha, kSaa, kTunedIwcpa, kRayMethodCount };

/// Medians in milliseconds, while tree, pipelines and buffers stand.
struct ReadyTime {
  double cpu = 0;  ///< casting or walking on the CPU
  double upload = 0, compute = 0, read_back = 0;
  [[nodiscard]] double total() const noexcept { return cpu + upload + compute + read_back; }
};

/// Medians in milliseconds, when there is nothing yet but the scene's triangles, here and on the device.
struct FirstTime {
  double boxes = 0;  ///< of the objects, out of their triangles
  double made = 0;   ///< tree, pipelines and buffers
  double cast = 0;   ///< rays, and the set out of their hits
  double frame = 0;  ///< that draws the set
  [[nodiscard]] double total() const noexcept { return boxes + made + cast + frame; }
};

struct RayPvsModel {
  int model = 1;
  scene::StrataCount full;  ///< with the paper's triangles
  std::size_t meshes = 0;
  std::uint64_t triangles = 0;  ///< measured with
  Box extent;
  std::array<ReadyTime, kRayMethodCount> ready;
  std::array<FirstTime, kRayMethodCount> first;
  bool identical = true;  ///< all methods met the same objects at the same distances
  /// Against the item buffer at the viewpoint V: the boxes' PVS, and what guided rays find there.
  std::size_t visible = 0, kept = 0, lost_objects = 0;
  std::uint64_t lost_pixels = 0, guided_lost_pixels = 0, guided_rays = 0, object_pixels = 0;
  double guided_ms = 0;
};

/// Figure 13: a frame's milliseconds with everything drawn, and with the PVS alone, from one viewpoint.
struct RayViewpoint {
  Vec3 eye;
  std::size_t kept = 0;
  double everything_ms = 0, pvs_ms = 0;
  [[nodiscard]] double ratio() const noexcept { return everything_ms / pvs_ms; }
};

/// BOCA's sets looked up along a path, computed ahead at viewpoints so many degrees apart; or cast there.
struct BreakTime {
  double spacing = 0;  ///< degrees
  std::size_t viewpoints = 0, frames = 0, bytes = 0;
  double idle_ms = 0;                  ///< of computing all sets ahead
  double cast_ms = 0, look_up_ms = 0;  ///< a frame's, medians
  std::uint64_t pixels = 0;            ///< that show something, over all frames
  std::uint64_t cast_lost_pixels = 0, look_up_lost_pixels = 0;
  std::uint64_t between_lost_pixels = 0;  ///< of objects that a cast there keeps, and the look-up does not
  double worst_share = 0;                 ///< of a frame's pixels that are those
};

/// A picture in the report's folder; with `before` the second of two under a slider.
struct RayPicture {
  std::string figure, file, caption, before;
};

struct RayPvs {
  std::string machine, device_kind;
  std::vector<RayPvsModel> models;
  std::vector<RayViewpoint> viewpoints;
  std::vector<BreakTime> break_time;
  std::vector<RayScene> scenes;
  std::vector<std::string> left_out;  ///< scenes that are not there, and why
  std::vector<RayPicture> pictures;
};

struct RayPvsOptions {
  bool quick = false;
  std::uint32_t rays = 100, width = 1280, height = 720;
  std::uint64_t triangles = 0;  ///< of a model; 0: a hundredth of the paper's
  std::string pictures;         ///< folder, made where it is not there; empty: none
};

/// Model by model, methods by turns; then the viewpoints around model 4, the break-time on model 1, and rays
/// against triangles on all. Throws Error where a picture cannot be written.
RayPvs measure_ray_pvs(device::Device& device, const RayPvsOptions& options, const Progress& progress = {});

/// One model from V; adds its pictures to `pictures`.
RayPvsModel measure_ray_model(int model, device::Device& device, const RayPvsOptions& options,
                              std::vector<RayPicture>& pictures);
/// Viewpoints all around model 4, 40 km from its middle, as V is; adds their picture to `pictures`.
std::vector<RayViewpoint> measure_ray_viewpoints(device::Device& device, const RayPvsOptions& options,
                                                 std::vector<RayPicture>& pictures);
/// Along a part of a circle around model 1, V first.
std::vector<BreakTime> measure_break_time(const RayPvsOptions& options);

/// Tables and figures; of a measurement that is empty what is published alone.
Reproduction ray_pvs_reproduction(const RayPvs& measured);

}  // namespace sightline::reproduce
