// The potentially visible sets that a game level carries: its BSP tree, the leaves' clusters, and which
// cluster may see which, computed once by the level's own compiler.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <sightline/types.hpp>

namespace sightline {

/// A Quake 3 level's space partition and visibility in Sightline's space (metres, y up).
struct LevelPvs {
  struct Node {
    Plane plane;              ///< unit normal
    std::int32_t front = -1;  ///< child where signed distance >= 0: a node, or leaf -(child + 1)
    std::int32_t back = -1;
  };
  struct Leaf {
    std::int32_t cluster = -1;  ///< -1: solid, or outside the level
    Box bounds;
    std::uint32_t first_object = 0, object_count = 0;  ///< range of `leaf_objects`
  };

  std::vector<Node> nodes;  ///< node 0 is the root
  std::vector<Leaf> leaves;
  std::vector<std::uint32_t> leaf_objects;  ///< object ids, leaf by leaf
  std::uint32_t clusters = 0;
  std::uint32_t bytes_per_cluster = 0;
  std::vector<std::uint8_t> visibility;  ///< clusters × bytes_per_cluster bits; empty: all see all
  /// Metres from the eye beyond which the level is not drawn and its visibility says nothing.
  float far_plane = std::numeric_limits<float>::infinity();
  std::vector<std::uint8_t> in_some_leaf;    ///< one an object: 1 where a leaf of the tree lists it
  std::vector<std::uint8_t> in_world_model;  ///< one an object: 0 for a face of a moving part (door, lift)

  /// Index of the leaf that holds the point.
  [[nodiscard]] std::uint32_t leaf_at(const Vec3& point) const noexcept;
  /// Whether something in cluster `to` may be seen from cluster `from`; true for cluster -1.
  [[nodiscard]] bool may_see(std::int32_t from, std::int32_t to) const noexcept;
  /// Sets mask[o] to 1 for each object in a leaf that may be seen from the leaf at `eye`, and for each object
  /// that no leaf lists; 0 for the rest. Mask: one byte an object. From inside solid, everything is set.
  void potentially_visible(const Vec3& eye, std::span<std::uint8_t> mask) const noexcept;
};

/// Throws Error unless every child, range, cluster and object id is in range and the nodes are a tree, at
/// most 1024 one above the other, so that the functions above are safe.
void check(const LevelPvs& level, std::size_t object_count);

}  // namespace sightline
