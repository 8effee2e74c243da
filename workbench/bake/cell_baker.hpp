// What can be seen from anywhere in a cell, by rays in all directions from points of it until they find
// nothing new.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sightline/pvs.hpp>
#include <sightline/workbench/scene.hpp>

#include "workbench/partition/triangle_rays.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::bake {

struct CellOptions {
  float cell = 3;        ///< metres along each side of a cell, about
  double target = 1e-4;  ///< share of what a view from the cell shows that its set may lack
  std::uint64_t seed = 1;
  std::uint32_t rays = 8;  ///< in all directions from each viewpoint
  std::uint32_t most_viewpoints = 1u << 18;
};

/// The grid over the scene, all cells closed and empty. Throws Error where that would be more than 2^22
/// cells.
CellPvs make_cells(const Scene& scene, const CellOptions& options);

/// Bakes cell after cell; the answer for a cell depends on scene, options and cell alone. One a thread.
class CellBaker {
public:
  CellBaker(const Scene& scene, const partition::TriangleRays& rays, const CellOptions& options);

  /// False where no point of the cell is open (inside a level, a leaf that belongs to a cluster). Else the
  /// objects seen, ascending.
  ///
  /// Viewpoints are spread evenly over the open part (the R3 sequence of Roberts 2018), few rays from each: a
  /// nook behind a curve that shows what nothing else does is missed for want of viewpoints, not of rays.
  /// Around a viewpoint that found something new, many more are cast. Ends when of the rays from the last
  /// 3 / target viewpoints at most target / 2 met something new: by then, what a nook of more than the target
  /// share of the cell shows is missed once in e^3 = 20 times, were the viewpoints random.
  bool bake(const CellPvs& cells, std::uint32_t cell, std::vector<ObjectId>& visible);
  /// Casts a batch of rays as bake() does first, and says whether the cell is open; for an estimate.
  bool try_out(const CellPvs& cells, std::uint32_t cell);
  /// The rays that bake() casts into an open cell at least, before it follows what they find.
  [[nodiscard]] double least_rays() const noexcept;
  [[nodiscard]] std::uint64_t rays_cast() const noexcept { return stats_.rays; }

private:
  void begin();
  void look(const Vec3& eye, std::span<const Vec3> directions, scene::Random& random);
  std::uint64_t cast();
  void follow(const Box& cell, scene::Random& random);

  const Scene& scene_;
  const partition::TriangleRays& rays_;
  CellOptions options_;
  std::vector<Vec3> few_, many_;  ///< directions
  std::vector<ObjectId> see_through_;
  partition::TriangleRays::Stack stack_;
  rays::RayStats stats_;
  std::vector<Ray> batch_;
  std::vector<ObjectId> nearest_;
  std::vector<Vec3> leads_;  ///< where something new was seen from
  std::vector<std::uint8_t> seen_, known_;
};

}  // namespace sightline::bake
