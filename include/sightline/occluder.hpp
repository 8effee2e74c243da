// Occluders made out of meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <sightline/status.hpp>
#include <sightline/types.hpp>

namespace sightline {

/// Which sides of a triangle are drawn, and so occlude. Its front is the side from which its corners turn
/// counter-clockwise, in mesh space: a mirroring transform turns nothing inside out, as glTF has it.
enum class Sides : std::uint8_t { both, front };

/// What is drawn along an edge that other triangles' edges cover in pieces, with corners exactly on it. A
/// rasteriser moves corners to its grid and may show single pixels of what lies behind there.
enum class TJunctions : std::uint8_t {
  open,    ///< such edges are outlines, so that those pixels are never called hidden
  closed,  ///< such edges are seams: hides what only those pixels show; rays through pixel centres lose
           ///< nothing
};

/// Triangles that occlude. Vertices at one place are joined, and each triangle knows its neighbours, so that
/// the seams between triangles are tight while the outline is drawn a little smaller than it is. Seams are
/// edges that two or more triangles share, and T-junctions if asked for. What can be looked through
/// (cut-outs, glass) must not be among them.
///
/// Unless a function says otherwise: Errors: none. Cost: constant. Threads: any number may draw one mesh at
/// once. Allocates: nothing.
class OccluderMesh {
public:
  /// Without a triangle.
  OccluderMesh();
  ~OccluderMesh();
  OccluderMesh(OccluderMesh&&) noexcept;
  OccluderMesh& operator=(OccluderMesh&&) noexcept;

  /// Three indices a triangle, each below positions.size(); positions in metres. `sides` has one entry a
  /// triangle, or one for all of them; without any, both sides occlude. Triangles that join to fewer than
  /// three corners are left out. Errors: bad_mesh for indices that are not a multiple of three or out of
  /// range (index(): which index), for positions that are not finite (index(): which position) and for
  /// another number of sides; too_many beyond 2³⁰ triangles or 2³² - 2 positions. Cost: n log n, some 2 µs a
  /// triangle: build once. Allocates: about 300 bytes a triangle.
  static Result<OccluderMesh> make(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                                   std::span<const Sides> sides = {},
                                   TJunctions junctions = TJunctions::open);
  /// The same where one answer does for all triangles.
  static Result<OccluderMesh> make(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                                   Sides sides, TJunctions junctions = TJunctions::open) {
    return make(positions, indices, {&sides, 1}, junctions);
  }

  /// How many triangles are left.
  [[nodiscard]] std::size_t triangles() const noexcept;

private:
  friend class OcclusionBuffer;
  friend struct OcclusionAccess;
  struct Topology;
  Topology* topology_;
};

}  // namespace sightline
