// The memory of an OcclusionBuffer.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <sightline/jobs.hpp>
#include <sightline/occlusion.hpp>

#include "library/geometry/aligned_vector.hpp"
#include "library/geometry/box_reader.hpp"
#include "library/geometry/error_bounds.hpp"
#include "library/geometry/linear.hpp"
#include "library/occlusion/convex.hpp"
#include "library/occlusion/eye_projection.hpp"
#include "library/occlusion/mesh_bands.hpp"
#include "library/occlusion/occluder_topology.hpp"

namespace sightline::occlusion {

using geometry::BoxSpan;
using geometry::ExactAffine;
using geometry::SphereSpan;

inline constexpr std::uint32_t kTile = 8;  ///< pixels a side

/// What a view has found out about a mesh. Reused from mesh to mesh.
struct MeshScratch {
  /// So many groups are in view: their numbers, their boxes (min x, y, z, max x, y, z), and their depths in
  /// steps. Lists have room for a vector more.
  std::size_t in_view = 0;
  std::vector<std::uint32_t> group, step;
  std::array<geometry::AlignedVector<float>, 6> box;
  static constexpr std::int32_t kSteps = 256;
  std::vector<std::uint32_t> near_first;  ///< places in these lists
  /// Which way a triangle turns, in groups whose `known` says `turn`.
  geometry::AlignedVector<float> facing;
  /// Beside it, where a pixel's margin counts: how much its nearness changes over a pixel at most; with a
  /// minus sign where the near plane cuts the triangle and it counts.
  geometry::AlignedVector<float> slant;
  std::vector<std::uint32_t> known;
  std::uint32_t turn = 0;
  float front = 1;       ///< which way triangles turn on the image that are seen from their front
  CostSteps cost_steps;  ///< empty where nobody asks

  /// Notes a polygon that reaches into so many tiles of these rows.
  void note_cost(std::uint32_t begin_row, std::uint32_t end_row, std::uint32_t columns) noexcept {
    if (!kSharesByCost || cost_steps.empty()) return;
    constexpr std::int64_t kPolygon = 16;  // of a row
    cost_steps[begin_row] += columns + kPolygon, cost_steps[end_row] -= columns + kPolygon;
  }
};

/// The nearness of a tile that one plane covers.
struct TilePlane {
  float base, across, down;  ///< at the first pixel's centre, and its growth
};

/// All that is written of such tiles: a value a tile.
template <class Floats>
struct TilePlanes {
  Floats base, across, down;

  [[nodiscard]] TilePlane of(std::size_t tile) const noexcept {
    return {base[tile], across[tile], down[tile]};
  }
};

/// Tiles of 2^n tiles a side, for queries of rectangles of many tiles.
inline constexpr std::uint32_t kCoarseLevels = 4;
struct CoarseTiles {
  std::uint32_t levels = 0;  ///< that are known; what they say is of some time ago, and safe: tiles only fill
  std::size_t drawn = 0;     ///< since
};

/// Where the tiles lie. What is undefined below is left as it was, so that a frame pays for what it draws.
struct TileMemory {
  geometry::AlignedVector<float> farthest, nearest, nearness, untouched;
  TilePlanes<geometry::AlignedVector<float>> plane;
  std::vector<MeshScratch> scratch;  ///< one a job that draws; the first is there once a view is begun
  BandHistory history;               ///< of the meshes that jobs draw
  CoarseTiles coarse;
};

struct BoxQuestions;

/// A view's tiles, or a band of them for one of many who draw at once: rows of tiles of its own.
struct DepthTiles {
  WorldView view{{{}, {}, 1, 1}, {}};
  OcclusionOptions options;
  bool begun = false;
  EyeProjection projection;
  PixelRays rays;
  std::uint32_t width = 0, height = 0;  ///< in pixels of the buffer
  std::uint32_t scale = 1;              ///< pixels of the view along a side of one of the buffer's
  /// How far from a pixel's centre, along x and y, an occluder must cover all and what is asked for counts.
  float margin = 0;
  /// How far rounding may move a corner within the image, in pixels: more in telescopes, and of meshes whose
  /// placement skews them.
  float rounding = 0;
  std::uint32_t columns = 0, rows = 0;  ///< tiles
  std::uint32_t stride = 0;             ///< tiles from row to row, a multiple of 16 beyond the columns
  /// Rows of pixels that are drawn to and asked for; whole tiles, but at the image's end.
  std::uint32_t first_row = 0, end_row = 0;
  /// One a tile: no pixel of it is farther; -infinity where some pixel has no occluder. Padding: +infinity.
  /// Behind the last row those of coarser levels.
  float* farthest = nullptr;
  std::uint32_t level_rows = 0;  ///< the rows as a multiple of 16: of level n there are a 2^n-th
  CoarseTiles* coarse = nullptr;
  /// One a tile: no pixel of it is nearer; -infinity where nothing was drawn.
  float* nearest = nullptr;
  /// `base` is -infinity where `nearness` has the tile, and undefined where nothing was drawn.
  TilePlanes<float*> plane{};
  /// 64 a tile, row by row; undefined where `nearest` is -infinity or a plane covers the tile. Pixels without
  /// an occluder hold -infinity, those beyond the image +infinity.
  float* nearness = nullptr;
  /// What an untouched tile holds: one within the image, in the last column, in the last row, in both.
  const float* untouched = nullptr;

  MeshScratch* mesh = nullptr;

  /// A cull's way to what answers for boxes; set where the buffer is begun, so that programs that never begin
  /// one need not link it.
  const BoxQuestions* ask = nullptr;

  /// Where a coarser level begins in `farthest`; 0 is the tiles themselves.
  [[nodiscard]] std::uint32_t first_row_of(std::uint32_t level) const noexcept {
    return 2 * level_rows - (2 * level_rows >> level);
  }
  /// How far from a pixel's centre kInset is not enough to tell what an occluder covers.
  [[nodiscard]] float around() const noexcept { return margin + std::max(0.0f, rounding - geometry::kInset); }
};

/// The plane's nearness at a pixel of its tile, to the bit as vectors of pixels have it.
inline float nearness_of(const TilePlane& plane, std::uint32_t column, std::uint32_t row) noexcept {
  float at =
      plane.base + (plane.across * static_cast<float>(column) + plane.down * static_cast<float>(row % 2));
  for (std::uint32_t pair = 0; pair < row / 2; ++pair) at += 2 * plane.down;
  return at;
}

/// A box that crosses the near plane, about the eye.
void draw_clipped_box(DepthTiles& tiles, const std::array<float, 3>& low,
                      const std::array<float, 3>& high) noexcept;
/// Where another triangle goes on at an edge, so that it is drawn tight: along the line x = at + slope·y that
/// the other has, too, or, `through_near`, along the one that both find where the near plane cuts the edge.
struct SeamLine {
  enum class Kind : std::uint8_t { none, given, through_near };
  Kind kind = Kind::none;
  float at = 0, slope = 0;
};
/// What lies around a triangle: edge k goes from corner k to the next. Where a pixel's margin counts, the
/// bands in which the mesh ends, and the slant of the steepest.
struct Surroundings {
  std::array<SeamLine, 3> seams;
  Bands without;
  float slant = 0;
};
/// A triangle that crosses the near plane, about the eye; drawn only if it turns that way on the image, 1 or
/// -1, or whichever way it turns for 0. Returns how many tiles lie around what was drawn.
std::uint32_t draw_clipped_triangle(DepthTiles& tiles, const std::array<glm::dvec3, 3>& corners, float way,
                                    const Surroundings& around) noexcept;
void draw_boxes(DepthTiles& tiles, std::span<const Box> boxes) noexcept;
void draw_spheres(DepthTiles& tiles, std::span<const Sphere> spheres) noexcept;
/// What drawing may cost of a mesh that is drawn in parts: groups of 16 triangles, near ones first, those
/// alone that it pays for. In any one unit; counted alike for any width of vectors.
struct MeshBudget {
  double look = 0;       ///< a group, whether it is in view
  double query = 0;      ///< a group in view, whether it is hidden
  double triangle = 0;   ///< one of a group that is set up
  double polygon = 0;    ///< one that is drawn: a triangle, or some that are flat together
  double tile = 0;       ///< a tile of the rectangle around it
  double left = 0;       ///< what may still be spent
  bool refused = false;  ///< whether something was left out for want of it

  [[nodiscard]] bool affords(double cost) noexcept {
    refused |= !(cost <= left);
    return cost <= left;
  }
  bool pay(double cost) noexcept {
    if (!affords(cost)) return false;
    left -= cost;
    return true;
  }
};
/// Draws all of the mesh, in as many bands of the image at once as there are jobs. `placement` is to metres
/// about the view's origin; one that place() refuses draws nothing. Allocates until it has seen its largest
/// mesh.
void draw_mesh(DepthTiles& tiles, TileMemory& memory, const OccluderTopology& mesh,
               const ExactAffine& placement, const JobSystem& jobs);
/// The same by one thread; with a budget what that pays for.
void draw_mesh(DepthTiles& tiles, const OccluderTopology& mesh, const ExactAffine& placement,
               MeshBudget* budget = nullptr);
/// To be told that so many boxes, spheres or groups of triangles were drawn: makes the coarser levels where
/// that pays. Not while others draw.
void note_drawn(DepthTiles& tiles, std::size_t things) noexcept;
void query_boxes(const DepthTiles& tiles, const EyeProjection& projection, const BoxSpan& boxes,
                 std::uint8_t* visible) noexcept;
struct BoxQuestions {
  decltype(&eye_projection) projection;
  decltype(&query_boxes) boxes;
};
void query_spheres(const DepthTiles& tiles, const EyeProjection& projection, const SphereSpan& spheres,
                   std::uint8_t* visible) noexcept;
/// Three corners a triangle.
bool query_triangles(const DepthTiles& tiles, std::span<const Vec3> corners) noexcept;

/// Four triangles ready to be asked for: a value a triangle, by corner and axis. Of fewer the last again.
struct TriangleBlock {
  static constexpr std::size_t kSize = 4;
  alignas(16) std::array<std::array<std::array<float, kSize>, 3>, 3> corners;
};
/// Fills blocks with triangles, three corners each, but those that show nothing: two of their corners are
/// one. Returns how many there are. There are blocks for all.
std::uint32_t fill_blocks(std::span<const Vec3> corners, std::span<TriangleBlock> blocks) noexcept;
/// The first `count` triangles of whole blocks, which may be seen from these sides.
struct TriangleRun {
  const TriangleBlock* blocks = nullptr;
  std::uint32_t count = 0;
  Sides sides = Sides::both;
};
/// seen[i] = 1 where some triangle of run i may be seen, else 0. Short runs are asked for together.
void query_triangles(const DepthTiles& tiles, std::span<const TriangleRun> runs, std::uint8_t* seen) noexcept;

}  // namespace sightline::occlusion

namespace sightline {

struct OcclusionBuffer::State : occlusion::DepthTiles {
  occlusion::TileMemory memory;
};
struct OccluderMesh::Topology : occlusion::OccluderTopology {};

/// The way of the library's own to what a buffer holds.
struct OcclusionAccess {
  static const occlusion::DepthTiles& tiles(const OcclusionBuffer& buffer) noexcept { return *buffer.state_; }
  static occlusion::DepthTiles& tiles(OcclusionBuffer& buffer) noexcept { return *buffer.state_; }
  static const occlusion::OccluderTopology& topology(const OccluderMesh& mesh) noexcept {
    return *mesh.topology_;
  }
};

}  // namespace sightline
