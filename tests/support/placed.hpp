// Random placements of instances, and what a cull of them said.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <sightline/instances.hpp>

#include "library/geometry/linear.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::test {

/// A rotation times a scale, and a translation.
inline Mat4 random_turn(scene::Random& random, float scale, const Vec3& at) {
  using geometry::to_double;
  const glm::dvec3 x = glm::normalize(to_double(random.direction()));
  glm::dvec3 other = to_double(random.direction());
  if (glm::length(glm::cross(x, other)) < 0.1) other = {x.y, x.z, -x.x};
  const glm::dvec3 y = glm::normalize(glm::cross(x, other)), z = glm::cross(x, y);
  const double s = scale;
  glm::dmat4 m(1.0);
  m[0] = glm::dvec4(x * s, 0), m[1] = glm::dvec4(y * s, 0), m[2] = glm::dvec4(z * s, 0);
  m[3] = glm::dvec4(to_double(at), 1);
  return geometry::to_mat4(m);
}

/// What a cull said of each object of each instance.
struct Said {
  std::uint8_t mask = 0, level = 0, fade = 0;
};
using AllSaid = std::map<std::pair<ObjectId, std::uint32_t>, std::vector<Said>>;

inline AllSaid all_said(const InstanceCullResult& result) {
  AllSaid out;
  std::uint64_t objects = 0;
  for (const InstanceRange& range : result.ranges) {
    EXPECT_GT(range.count, 0u);
    objects += range.count;
    for (std::size_t i = range.first; i < std::size_t{range.first} + range.count; ++i)
      out[{range.instance, result.ids[i]}].push_back(
          {result.masks.empty() ? std::uint8_t{1} : result.masks[i],
           result.levels.empty() ? std::uint8_t{0} : result.levels[i],
           result.fades.empty() ? std::uint8_t{0} : result.fades[i]});
  }
  EXPECT_EQ(objects, result.objects);
  return out;
}

}  // namespace sightline::test
