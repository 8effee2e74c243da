#include <sightline/workbench/level_pvs.hpp>

#include <algorithm>

#include <sightline/frustum.hpp>
#include <sightline/workbench/error.hpp>

namespace sightline {

std::uint32_t LevelPvs::leaf_at(const Vec3& point) const noexcept {
  std::int32_t at = nodes.empty() ? -1 : 0;
  while (at >= 0) {
    const Node& node = nodes[static_cast<std::size_t>(at)];
    at = signed_distance(node.plane, point.x, point.y, point.z) >= 0 ? node.front : node.back;
  }
  return static_cast<std::uint32_t>(-(at + 1));
}

bool LevelPvs::may_see(std::int32_t from, std::int32_t to) const noexcept {
  if (from < 0 || to < 0 || visibility.empty()) return true;
  const std::size_t byte =
      static_cast<std::size_t>(from) * bytes_per_cluster + static_cast<std::size_t>(to) / 8;
  return (visibility[byte] >> (to % 8) & 1) != 0;
}

void LevelPvs::potentially_visible(const Vec3& eye, std::span<std::uint8_t> mask) const noexcept {
  const std::int32_t from = leaves[leaf_at(eye)].cluster;
  if (from < 0) {
    std::fill(mask.begin(), mask.end(), std::uint8_t{1});
    return;
  }
  for (std::size_t o = 0; o < mask.size(); ++o) mask[o] = in_some_leaf[o] == 0;
  for (const Leaf& leaf : leaves) {
    if (leaf.cluster < 0 || !may_see(from, leaf.cluster)) continue;
    for (std::uint32_t i = 0; i < leaf.object_count; ++i) mask[leaf_objects[leaf.first_object + i]] = 1;
  }
}

namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw Error("level PVS: " + what);
}

/// Real levels have some tens of nodes one above the other; looking up a point walks down them all.
constexpr std::uint16_t kMaxDepth = 1024;

void check_tree(const LevelPvs& level) {
  std::vector<std::uint16_t> depth(level.nodes.size(), 0);  ///< 0 but for children
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const std::string node = "node " + std::to_string(i);
    for (const std::int64_t child : {level.nodes[i].front, level.nodes[i].back}) {
      if (child < 0) {
        if (-(child + 1) >= static_cast<std::int64_t>(level.leaves.size()))
          refuse(node + " has a leaf out of range");
        continue;
      }
      // Compilers write parents before children, so a larger index is also what rules out a circle.
      if (child <= static_cast<std::int64_t>(i) || child >= static_cast<std::int64_t>(level.nodes.size()))
        refuse(node + " has a child out of order or range");
      std::uint16_t& below = depth[static_cast<std::size_t>(child)];
      if (below != 0) refuse(node + " has a child that another node has too, expected a tree");
      below = static_cast<std::uint16_t>(depth[i] + 1);
      if (below >= kMaxDepth)
        refuse(node + " has a child below " + std::to_string(kMaxDepth) + " others, expected fewer");
    }
  }
}

}  // namespace

void check(const LevelPvs& level, std::size_t object_count) {
  if (level.leaves.empty()) refuse("it has no leaf");
  if (level.in_some_leaf.size() != object_count || level.in_world_model.size() != object_count) {
    refuse("expected one flag an object");
  }
  check_tree(level);
  for (std::size_t i = 0; i < level.leaves.size(); ++i) {
    const LevelPvs::Leaf& leaf = level.leaves[i];
    if (std::uint64_t{leaf.first_object} + leaf.object_count > level.leaf_objects.size()) {
      refuse("leaf " + std::to_string(i) + " lists objects out of range");
    }
    if (!level.visibility.empty() && leaf.cluster >= static_cast<std::int64_t>(level.clusters)) {
      refuse("leaf " + std::to_string(i) + " has a cluster out of range");
    }
  }
  for (std::uint32_t object : level.leaf_objects) {
    if (object >= object_count) refuse("a leaf lists object " + std::to_string(object) + ", out of range");
  }
  if (!level.visibility.empty() &&
      (level.visibility.size() != std::uint64_t{level.clusters} * level.bytes_per_cluster ||
       std::uint64_t{level.bytes_per_cluster} * 8 < level.clusters)) {
    refuse("the visibility matrix has the wrong size");
  }
}

}  // namespace sightline
