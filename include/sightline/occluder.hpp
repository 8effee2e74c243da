// Occluders made out of meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

/// From one corner of a mesh to another.
struct OccluderEdge {
  Vec3 from, to;  ///< metres
};

/// Triangles that occlude. Vertices at one place are joined, and each triangle knows its neighbours, so that
/// the seams between triangles are tight while the outline is drawn a little smaller than it is. Seams are
/// edges that two or more triangles share, and T-junctions if asked for. What can be looked through
/// (cut-outs, glass) must not be among them.
///
/// What was moved from may only be destroyed or assigned to. Unless a function says otherwise: Errors: none.
/// Cost: constant. Threads: any number may draw one mesh at once. Allocates: nothing.
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
  /// another number of sides; bad_argument for sides (index(): which entry) and junctions that are none;
  /// too_many beyond 2³⁰ triangles or 2³² - 2 positions. Cost: n log n, some 2 µs a triangle: build once.
  /// Allocates: about 300 bytes a triangle.
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
  /// How many of their edges are no seams from any side, and so are always drawn inset, each counted at every
  /// triangle that has it; the first of them, as many as there is room for, come back in `edges`. Cost:
  /// linear in the triangles.
  std::size_t open_edges(std::span<OccluderEdge> edges = {}) const noexcept;

private:
  friend class OcclusionBuffer;
  friend struct OcclusionAccess;
  struct Topology;
  Topology* topology_;
};

/// How much make_occluder may make of a mesh: something, so not both may be 0.
struct OccluderOptions {
  std::uint32_t most_triangles = 64;  ///< 4096 at most; 0: boxes alone
  std::uint32_t most_boxes = 8;       ///< 4096 at most; 0: triangles alone, which is quicker
};

/// What make_occluder found.
enum class OccluderYield : std::uint8_t {
  whole,  ///< all of the mesh, in no more triangles than were allowed
  parts,  ///< what lies inside it, its largest flat parts, or both
  thin,   ///< nothing: it is open or thin, and has no large flat part
  empty,  ///< nothing: it has no triangle
};

/// The same in a sentence. Errors: none. Cost: constant. Threads: any. Allocates: nothing.
const char* to_string(OccluderYield yield) noexcept;

/// What occludes in a mesh's place, in the mesh's space: triangles for OccluderMesh::make, and boxes for who
/// draws those. From wherever one looks, it covers no point that the mesh, drawn from its sides, does not
/// cover as near or nearer. Boxes and solid triangles lie inside the mesh and hide what is inside, too: like
/// a solid box they are for eyes and near planes outside of it.
struct Occluder {
  std::vector<Vec3> positions;         ///< metres
  std::vector<std::uint32_t> indices;  ///< three a triangle
  std::vector<Sides> sides;            ///< one a triangle
  std::size_t solid_triangles = 0;     ///< so many, the first, lie inside; the others are the mesh's own
  std::vector<Box> boxes;              ///< inside the mesh too, in other words: the largest first
  OccluderYield yield = OccluderYield::empty;  ///< what was found, or why nothing was
};

/// Makes an occluder of any mesh, closed or not: positions, indices and sides as OccluderMesh::make has them.
/// What can be looked through must not be among the triangles.
///
/// Flat pieces are merged where they lie on one plane (within 1e-6 of the largest coordinate), along edges
/// that are straight but for the rounding of their corners. Where all of that is no more than
/// options.most_triangles, it is the occluder. Otherwise these are shared out among the parts that hang
/// together, by their size: a closed part gets a convex hull of its own points where that lies inside, or a
/// simplified surface or boxes inside it (surface nets, Gibson 1998; edge collapses, Garland & Heckbert
/// 1997), whichever covers most; or its largest flat triangles, where these do. An open part is closed by a
/// lid for that, and those triangles are taken, one-sided, whose planes have all of its open edges behind
/// them: of a dome or a hill, seen from above, much; of a valley nothing, unless it comes with walls and a
/// floor. A part is closed where every edge has as many triangles of either direction, or an even number of
/// both-sided ones; where some are drawn from their front alone they must look outwards. Every triangle and
/// box is judged by itself before it is taken: none comes nearer to the surface than 5e-5 of the part's box.
/// What is thinner than 1/32 of its part is seen as flat or not at all.
///
/// Errors: as OccluderMesh::make; bad_argument for options out of range or without room for anything. Cost: n
/// log n; a tenth of a second to half of one a large part. Threads: any. Allocates: about 400 bytes a
/// triangle, meanwhile.
Result<Occluder> make_occluder(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                               std::span<const Sides> sides = {}, const OccluderOptions& options = {});

}  // namespace sightline
