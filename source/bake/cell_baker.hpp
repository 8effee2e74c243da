// What can be seen from anywhere in a cell, by rays in all directions from points of it until they find
// nothing new.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/cell_pvs.hpp>
#include <sightline/scene.hpp>

#include "pvs/triangle_rays.hpp"

namespace sightline::bake {

struct CellOptions {
  float cell = 4;        ///< metres along each side of a cell, about
  double target = 1e-4;  ///< share of what a view from the cell shows that its set may lack
  std::uint64_t seed = 1;
  std::uint32_t rays = 1024;  ///< in all directions from each viewpoint
  std::uint32_t most_viewpoints = 4096;
};

/// The grid over the scene, all cells closed and empty. Throws Error where that would be more than 2^22
/// cells.
CellPvs make_cells(const Scene& scene, const CellOptions& options);

/// Bakes cell after cell; the answer for a cell depends on scene, options and cell alone. One a thread.
class CellBaker {
public:
  CellBaker(const Scene& scene, const pvs::TriangleRays& rays, const CellOptions& options);

  /// False where no point of the cell is open (inside a level, a leaf that belongs to a cluster). Else the
  /// objects seen, ascending. Ends when `quiet` rays in a row, of the last viewpoints, met at most target/2
  /// of new objects.
  bool bake(const CellPvs& cells, std::uint32_t cell, std::vector<ObjectId>& visible);
  [[nodiscard]] std::uint64_t rays_cast() const noexcept { return stats_.rays; }

private:
  const Scene& scene_;
  const pvs::TriangleRays& rays_;
  CellOptions options_;
  pvs::TriangleRays::Stack stack_;
  pvs::RayStats stats_;
  std::vector<Vec3> directions_;
  std::vector<Ray> batch_;
  std::vector<ObjectId> nearest_;
  std::vector<std::uint8_t> seen_, known_;
};

/// A random point of the cell where somebody can be; false after many tries in vain.
bool open_point(const Scene& scene, const Box& cell, std::uint64_t& state, Vec3& point);

}  // namespace sightline::bake
