// A world's answers beside brute force on a twin of what stands in it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include <sightline/world.hpp>

#include "library/geometry/linear.hpp"
#include "support/cull.hpp"
#include "support/run_threads.hpp"

namespace sightline::test {

inline WorldBox wide(const Box& b, const WorldPoint& by = {}) {
  return {{b.min.x + by.x, b.min.y + by.y, b.min.z + by.z}, {b.max.x + by.x, b.max.y + by.y, b.max.z + by.z}};
}

/// The planes around what a view sees, about its origin: unit normals that point inwards. From the matrices
/// alone, in double precision; without those at infinity.
inline std::vector<glm::dvec4> planes_of(const WorldView& view) {
  using namespace geometry;
  const glm::dmat4 rows =
      glm::transpose(to_double(view.view.eye_to_clip) * to_double(view.view.world_to_eye));
  std::vector<glm::dvec4> out;
  for (const glm::dvec4& plane : {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
                                  rows[2], rows[3] - rows[2]}) {
    const double length = glm::length(glm::dvec3(plane));
    if (length >= 1e-12 * std::fabs(plane.w)) out.push_back(plane / length);
  }
  return out;
}

/// Least signed distance of the box's best corner over all planes about an origin.
inline double depth_in(std::span<const glm::dvec4> planes, const WorldPoint& origin, const WorldBox& b) {
  double least = 1e300;
  for (const glm::dvec4& plane : planes) {
    const glm::dvec3 corner((plane.x >= 0 ? b.max.x : b.min.x) - origin.x,
                            (plane.y >= 0 ? b.max.y : b.min.y) - origin.y,
                            (plane.z >= 0 ? b.max.z : b.min.z) - origin.z);
    least = std::min(least, glm::dot(glm::dvec3(plane), corner) + plane.w);
  }
  return least;
}

inline void expect_right(const World& world, Culler& culler, const std::map<ObjectId, WorldBox>& twin,
                         std::span<const WorldView> views, double tolerance) {
  std::vector<ObjectId> visible(cull_capacity(world));
  std::vector<std::uint8_t> masks(visible.size());
  const std::vector<CullView> all = cull_views(views);
  const CullResult with_masks = cull(culler, world, all, visible, masks);
  std::map<ObjectId, std::uint8_t> seen;
  for (std::size_t i = 0; i < with_masks.count; ++i) {
    ASSERT_TRUE(twin.contains(visible[i]));
    ASSERT_NE(masks[i], 0);
    ASSERT_TRUE(seen.emplace(visible[i], masks[i]).second) << "written twice: " << visible[i];
  }
  std::vector<std::vector<glm::dvec4>> planes;
  for (const WorldView& view : views) planes.push_back(planes_of(view));
  for (const auto& [id, box] : twin) {
    for (std::size_t v = 0; v < views.size(); ++v) {
      const double depth = depth_in(planes[v], views[v].origin, box);
      const bool kept = seen.contains(id) && (seen[id] >> v & 1);
      if (depth >= 0) ASSERT_TRUE(kept) << "lost object " << id << " in view " << v;
      if (depth < -tolerance)
        ASSERT_FALSE(kept) << "kept object " << id << " in view " << v << " at " << depth;
    }
  }
  // So do threads, to the bit.
  const CullOptions threaded{.jobs = {run_threads, nullptr, 4}};
  std::vector<ObjectId> by_threads(cull_capacity(world, threaded));
  std::vector<std::uint8_t> their_masks(by_threads.size());
  ASSERT_EQ(cull(culler, world, all, by_threads, their_masks, threaded).count, with_masks.count);
  ASSERT_TRUE(std::equal(by_threads.begin(),
                         by_threads.begin() + static_cast<std::ptrdiff_t>(with_masks.count),
                         visible.begin()));
  ASSERT_TRUE(std::equal(their_masks.begin(),
                         their_masks.begin() + static_cast<std::ptrdiff_t>(with_masks.count), masks.begin()));
  // The plain passes say the same, in the same order.
  const CullResult plain = cull(culler, world, all, visible);
  ASSERT_EQ(plain.count, with_masks.count);
  for (std::size_t v = 0; v < views.size(); ++v) {
    std::vector<ObjectId> single(visible.size());
    const CullResult one = cull(culler, world, std::span(all).subspan(v, 1), single);
    std::size_t expected = 0;
    for (const auto& [id, mask] : seen) expected += mask >> v & 1;
    ASSERT_EQ(one.count, expected);
    for (std::size_t i = 0; i < one.count; ++i) ASSERT_TRUE(seen[single[i]] >> v & 1);
  }
}

}  // namespace sightline::test
