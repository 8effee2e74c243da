// Rays sent where they tell something: a coarse grid of pixels, more where neighbours disagree, then probes
// until it is all but certain that no more than a target share of the pixels shows what was not found.
#pragma once

#include <vector>

#include <sightline/view.hpp>

#include "library/rays/ray_grid.hpp"
#include "workbench/partition/triangle_rays.hpp"

namespace sightline::methods {

class GuidedRays {
public:
  struct Options {
    double target = 1e-4;        ///< share of all pixels that may show an object not found
    std::uint32_t spacing = 16;  ///< pixels between the first rays; a power of two
  };

  /// Sets seen[o] to 1 for every object that a ray through a pixel centre met (TriangleRays::cast).
  ///
  /// Ends when 5 / target probes in a row, in proportion to the pixels not yet looked through, found nothing
  /// new: were more than the target share lost, that would happen once in e^5 = 148 times. At worst every
  /// pixel is looked through, and nothing is lost.
  void cast(const View& view, const partition::TriangleRays& rays, const Options& options,
            std::span<std::uint8_t> seen, partition::TriangleRays::Stack& stack, rays::RayStats& stats);

private:
  void add(std::uint32_t x, std::uint32_t y);
  void flush(const partition::TriangleRays& rays, std::span<std::uint8_t> seen,
             partition::TriangleRays::Stack& stack, rays::RayStats& stats);

  std::uint32_t width_ = 0, height_ = 0;
  const rays::ViewRays* view_rays_ = nullptr;
  std::vector<ObjectId> nearest_;      ///< by pixel; kNotCast where no ray went
  std::vector<std::uint32_t> pixels_;  ///< of the rays that wait
  std::vector<Ray> rays_;
  std::vector<ObjectId> hits_;
  std::vector<std::uint32_t> cells_, finer_;  ///< corners of cells that disagree, this level's and the next's
};

}  // namespace sightline::methods
