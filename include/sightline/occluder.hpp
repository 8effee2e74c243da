// Occluders made out of meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <sightline/status.hpp>
#include <sightline/types.hpp>

namespace sightline {

/// Triangles that occlude. Vertices at one place are joined, and each triangle knows its neighbours, so that
/// the seams between triangles are tight while the outline is drawn a little smaller than it is. Both faces
/// of a triangle occlude: what can be looked through, or is not drawn from one side, must not be among them.
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

  /// Three indices a triangle, each below positions.size(); positions in metres. Triangles that join to fewer
  /// than three corners are left out. Errors: bad_mesh for indices that are not a multiple of three or out of
  /// range (index(): which index) and for positions that are not finite (index(): which position); too_many
  /// beyond 2³⁰ triangles or 2³² - 2 positions. Cost: n log n, some 2 µs a triangle: build once. Allocates:
  /// about 300 bytes a triangle.
  static Result<OccluderMesh> make(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

  /// How many triangles are left.
  [[nodiscard]] std::size_t triangles() const noexcept;

private:
  friend class OcclusionBuffer;
  friend struct OcclusionAccess;
  struct Topology;
  Topology* topology_;
};

}  // namespace sightline
