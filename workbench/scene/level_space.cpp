#include "workbench/scene/level_space.hpp"

#include <algorithm>
#include <cmath>

namespace sightline::scene {
namespace {

double distance(const Plane& plane, const Vec3& p) {
  return double{plane.normal.x} * p.x + double{plane.normal.y} * p.y + double{plane.normal.z} * p.z +
         plane.distance;
}

struct Part {
  std::int32_t child;
  double begin, end;  ///< of the segment, 0 … 1
};

}  // namespace

double solid_length(const LevelPvs& level, const Vec3& a, const Vec3& b) {
  double solid = 0;
  std::vector<Part> open{{level.nodes.empty() ? -1 : 0, 0, 1}};
  while (!open.empty()) {
    const Part part = open.back();
    open.pop_back();
    if (part.child < 0) {
      const LevelPvs::Leaf& leaf = level.leaves[static_cast<std::size_t>(-(part.child + 1))];
      if (leaf.cluster < 0) solid += part.end - part.begin;
      continue;
    }
    const LevelPvs::Node& node = level.nodes[static_cast<std::size_t>(part.child)];
    const double from = distance(node.plane, a), slope = distance(node.plane, b) - from;
    const double at_begin = from + slope * part.begin, at_end = from + slope * part.end;
    if (at_begin >= 0 && at_end >= 0) {
      open.push_back({node.front, part.begin, part.end});
    } else if (at_begin < 0 && at_end < 0) {
      open.push_back({node.back, part.begin, part.end});
    } else {
      const double cut = std::clamp(-from / slope, part.begin, part.end);
      open.push_back({at_begin >= 0 ? node.front : node.back, part.begin, cut});
      open.push_back({at_begin >= 0 ? node.back : node.front, cut, part.end});
    }
  }
  return solid * std::hypot(double{b.x} - a.x, double{b.y} - a.y, double{b.z} - a.z);
}

bool is_open(const LevelPvs& level, const Vec3& point) {
  return level.leaves[level.leaf_at(point)].cluster >= 0;
}

std::vector<std::uint32_t> open_leaves(const LevelPvs& level) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < level.leaves.size(); ++i) {
    const LevelPvs::Leaf& leaf = level.leaves[i];
    const bool has_volume = leaf.bounds.min.x < leaf.bounds.max.x && leaf.bounds.min.y < leaf.bounds.max.y &&
                            leaf.bounds.min.z < leaf.bounds.max.z;
    if (leaf.cluster >= 0 && has_volume) found.push_back(i);
  }
  return found;
}

}  // namespace sightline::scene
