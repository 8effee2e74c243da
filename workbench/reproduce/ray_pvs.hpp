// Ye et al. 2023, table 6 and figures 12 and 13: toca, boca, iwcpa, bvha and saa on five models of strata.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/device/frame_times.hpp"
#include "workbench/report/table.hpp"
#include "workbench/reproduce/ray_scenes.hpp"

namespace sightline::reproduce {

inline constexpr std::array<const char*, 5> kRayMethods{"toca", "boca", "iwcpa", "bvha", "saa"};
/// The paper's milliseconds, by method and model; 0 where it gives none.
inline constexpr double kPublishedRayMs[5][5] = {{919.8, 1434.9, 2180.1, 0, 0},
                                                 {170.5, 537.2, 616.3, 2591.6, 782.2},
                                                 {78.2, 68.5, 67.5, 70.7, 74.4},
                                                 {87.8, 513.4, 777.6, 2027.1, 785.9},
                                                 {19.2, 32, 40.1, 87.1, 88.8}};

/// Medians in milliseconds. The total is what a PVS costs once the tree is there: all but `build`.
struct RayTiming {
  double build = 0;  ///< tree, pipelines, buffers
  double cpu = 0;    ///< casting or walking on the CPU
  double upload = 0, compute = 0, read_back = 0;
  [[nodiscard]] double total() const noexcept { return cpu + upload + compute + read_back; }
};

struct RayPvsModel {
  int model = 1;
  std::size_t meshes = 0;
  std::uint64_t triangles = 0;
  std::array<RayTiming, 5> timing;  ///< as kRayMethods
  bool identical = true;            ///< all five met the same objects at the same distances
  /// Against the item buffer at the viewpoint: the boxes' PVS, and what guided rays find there.
  std::size_t visible = 0, kept = 0, lost_objects = 0;
  std::uint64_t lost_pixels = 0, guided_lost_pixels = 0, guided_rays = 0, object_pixels = 0;
  double guided_ms = 0;
};

struct RayPvsOptions {
  std::uint32_t rays = 100, width = 1280, height = 720;
  std::size_t repeats = 9;
  std::string pictures;  ///< folder for figure 12's pictures; empty: none
};

/// One model, methods by turns. Draws figure 12's pictures (everything, the PVS alone, where they differ) as
/// model-N-….png where a folder is given.
RayPvsModel measure_ray_model(int model, device::Device& device, const RayPvsOptions& options);

/// Figure 13: the frame's milliseconds for everything and for the PVS alone, over 3 × 3 regions of a model,
/// each looked at on its own.
struct RegionTime {
  int row = 0, column = 0;
  std::size_t kept = 0;
  double everything_ms = 0, pvs_ms = 0;
};
std::vector<RegionTime> measure_regions(int model, device::Device& device, const RayPvsOptions& options);

report::Table region_table(const std::vector<RegionTime>& regions);

/// Table 6: milliseconds, and the ratio to boca beside the published one.
report::Table ray_table(const std::vector<RayPvsModel>& models);
/// Build, CPU, upload, compute and read-back apart.
report::Table ray_parts_table(const std::vector<RayPvsModel>& models);
/// What each PVS lost.
report::Table ray_loss_table(const std::vector<RayPvsModel>& models);

/// Writes index.html to the folder of figure 12's pictures: every table, and the pictures model by model.
void write_ray_report(const std::string& device, const RayPvsOptions& options,
                      const std::vector<RayPvsModel>& models, const std::vector<RegionTime>& regions,
                      std::span<const RayScene> scenes);

}  // namespace sightline::reproduce
