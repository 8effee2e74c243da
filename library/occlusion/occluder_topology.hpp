// The triangles of an OccluderMesh, laid out for drawing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sightline/types.hpp>

#include "library/geometry/aligned_vector.hpp"

namespace sightline::occlusion {

struct OccluderTopology {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint8_t> one_sided;  ///< one a triangle: it occludes from its front alone
  /// Of edge k, from corner k to corner k+1: the only other triangle there, or kNone.
  std::vector<std::array<std::uint32_t, 3>> neighbours;
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// An edge without such a neighbour, at which others go on all the same: three and more triangles that
  /// share it, some that are wound the other way, or, if asked for, a row of them whose edges lie exactly on
  /// it (T-junctions). `others` holds them piece by piece; of each piece one must go on for the seam to be
  /// tight.
  struct SharedEdge {
    std::uint32_t triangle = 0, edge = 0;
    std::uint32_t first = 0, end = 0;  ///< in `others`
  };
  std::vector<SharedEdge> shared;  ///< by triangle
  /// Triangle · 4, + 2 where it is wound the other way, + 1 for the last of a piece.
  std::vector<std::uint32_t> others;
  /// A triangle's part in a flat convex polygon. Its triangles lie together within a group, that first whose
  /// plane is the polygon's.
  struct Part {
    std::uint8_t follows = 0;   ///< the triangle before is of the same polygon
    std::uint8_t inner = 0;     ///< a bit an edge: beyond it the polygon goes on
    std::uint8_t straight = 0;  ///< the first of a polygon some of whose corners go straight on, or all but
    float apart = 0;            ///< of the first: so far the others lie from its plane at most
  };
  static constexpr std::size_t kMostParts = 8, kMostSides = 10;  ///< of a polygon
  std::vector<Part> parts;

  /// Runs of triangles with a box that holds them: what is out of view or hidden as a whole is not set up.
  static constexpr std::uint32_t kGroup = 16;
  struct Group {
    /// A bit a triangle and edge: its second corner has the lower number.
    std::array<std::uint32_t, 3> turned{};
    std::array<std::uint32_t, 3> inner{};             ///< of Part
    std::uint32_t follows = 0, straight = 0;          ///< the same, a bit a triangle
    float apart = 0;                                  ///< the most of them
    std::uint32_t one_sided = 0;                      ///< a bit a triangle
    std::array<std::uint32_t, 3> one_sided_beyond{};  ///< of the neighbours at edge k
    std::uint32_t first_beside = 0, end_beside = 0;   ///< in `beside`
    std::uint32_t first_shared = 0, end_shared = 0;   ///< in `shared`
    std::uint32_t first_ring = 0, end_ring = 0;       ///< in `rings`
    std::uint32_t first_rim = 0, end_rim = 0;         ///< in `rim`
    std::uint32_t first_around = 0, end_around = 0;   ///< in `around`
    /// A bit a triangle: at its corners more than kMostAround edges end, which `rim` and `around` leave out.
    std::uint32_t alone = 0;
  };
  std::vector<Group> groups;          ///< group g holds triangles 16·g …
  std::vector<std::uint32_t> beside;  ///< of each group those that hold the others of its shared edges
  std::vector<std::uint32_t> rings;   ///< and those that hold what `around` names, itself left out
  static constexpr std::size_t kMostAround = 96;
  /// Edges that end at a corner of a group's triangles, or at a corner that lies on one of their edges: where
  /// the mesh ends at such an edge, pixels that it touches are not the triangle's. Of a triangle its own
  /// edges are none. What a block has no edge for is of no triangle.
  struct RimEdges {
    alignas(64) std::array<std::int32_t, kGroup> triangle{};
    /// The triangle's neighbour there; as unsigned numbers kNone, or kShared + a place in `shared`.
    alignas(64) std::array<std::int32_t, kGroup> other{};
    std::array<std::uint32_t, kGroup> a{}, b{};  ///< in `positions`
    std::array<std::uint16_t, kGroup> of{};      ///< a bit a triangle of the group
    std::uint16_t of_some = 0;                   ///< of any of them
  };
  static constexpr std::uint32_t kShared = 0x80000000u;
  std::vector<RimEdges> rim;
  /// The triangles on either side of these edges, and of which of them each of the group's is beside, a bit
  /// each.
  struct AroundTriangles {
    alignas(64) std::array<std::int32_t, kGroup> triangle{};
    std::array<std::uint16_t, kGroup> beside{};
  };
  std::vector<AroundTriangles> around;
  double diagonal = 0;  ///< of the box around all corners
  /// Per 16 groups the middles of their boxes, x, y, z, and half their sizes: 16 values each.
  geometry::AlignedVector<float> box;
  /// Per group, corner and axis 16 values, and per group and edge 16 neighbours or -1; beyond the last
  /// triangle its first corner three times, no neighbours. As corners, per edge the neighbour's third one;
  /// where there is none, an end of the edge.
  geometry::AlignedVector<float> corners, beyond;
  geometry::AlignedVector<std::int32_t> neighbour;
  /// Fills the arrays from `groups` on out of those before.
  void lay_out();
};

/// Numbers triangles anew, so that the boxes around runs of kGroup are small. O(n log n).
void sort_into_groups(OccluderTopology& mesh);
/// Finds `shared`, T-junctions only where they are to be closed. Neighbours are known, and triangles numbered
/// for good.
void find_shared_edges(OccluderTopology& mesh, bool close_junctions);
/// Finds `rim`, `around` and `rings`. The mesh is laid out.
void find_corner_edges(OccluderTopology& mesh);
/// Finds `parts`. Neighbours are known; triangles are numbered anew, near their old places.
void join_flat_polygons(OccluderTopology& mesh);

}  // namespace sightline::occlusion
