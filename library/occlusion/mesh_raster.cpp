// Triangles of meshes into the tiles.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <sightline/projection.hpp>

#include "library/occlusion/depth_tiles.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/occlusion/mesh_raster.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "library/occlusion/mesh_groups-inl.hpp"
#include "library/occlusion/mesh_rim-inl.hpp"
#include "library/occlusion/mesh_setup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// Adds the first `count` edges of triangle i.
HWY_INLINE void add_edges(const ReadyTriangles& ready, int i, std::size_t count, Convex& out) {
  std::uint32_t left = 0, right = 0;
  for (std::size_t k = 0; k < count; ++k) {
    out.slope[out.edges] = ready.slope[k][i];
    out.left_at[out.edges] = ready.left_at[k][i];
    out.right_at[out.edges++] = ready.right_at[k][i];
    left |= ready.on_left[k], right |= ready.on_right[k];
  }
  out.has_left |= left >> i & 1, out.has_right |= right >> i & 1;
}

// Of a group of triangles, those that are drawn as one: a triangle, or a quad's halves. Of a quad each adds
// two edges.
struct Piece {
  std::size_t first, count;
};

// Moves the edges of a piece inwards that are drawn tight, as if nothing went on there.
HWY_INLINE Convex inset_piece(const ReadyTriangles& ready, const Piece& piece, Convex tight) {
  const auto first = static_cast<int>(piece.first);
  const float inset =
      piece.count == 2 ? std::max(ready.inset[first], ready.inset[first + 1]) : ready.inset[first];
  tight.left += inset, tight.right -= inset, tight.top += inset, tight.bottom -= inset;
  tight.edges = 0;
  for (int i = first; i < first + static_cast<int>(piece.count); ++i) {
    const std::size_t edges = piece.count == 2 ? 2 : 3;
    for (std::size_t k = 0; k < edges; ++k) {
      const float slope = ready.slope[k][i],
                  inwards = ready.seam[k] >> i & 1 ? inset * (1 + std::fabs(slope)) : 0;
      if (ready.on_right[k] >> i & 1) tight.add_edge(true, ready.right_at[k][i] - inwards, slope);
      if (ready.on_left[k] >> i & 1) tight.add_edge(false, ready.left_at[k][i] + inwards, slope);
    }
  }
  return tight;
}

// Of the nearness: what is lowered by no more for its neighbours' sake is not drawn again on its own plane.
constexpr float kLeastDeeper = 1e-2f;

// Where a pixel's margin counts. First the pixels that are the piece's own; then those that it shares with
// others, as deep as the deepest of them may be there.
HWY_NOINLINE void draw_with_margin(DepthTiles& tiles, const ReadyTriangles& ready, const Rim& rim,
                                   const Piece& piece, const Convex& tight, const TileRange& range,
                                   TileList<1>& list) {
  const std::size_t last = piece.first + piece.count - 1;
  const float own = std::fabs(tight.across) + std::fabs(tight.down),
              slant = std::max(rim.slant[piece.first], rim.slant[last]),
              deeper = tiles.margin * std::max(0.0f, slant - own);
  const bool again = deeper > kLeastDeeper * std::fabs(ready.nearest[piece.first]);
  Bands bands;
  const bool known = bands_in(rim, 1u << piece.first | 1u << last, tight, bands);
  Convex shared = tight;
  shared.at -= deeper;
  if (known && !again && bands.count == 0) return list_polygon(tiles, shared, range, list);
  const Convex middle = inset_piece(ready, piece, tight);
  if (!known || again) list_polygon(tiles, middle, range, list);
  if (known) list_polygon(tiles, shared, range, bands, middle, list);
}

HWY_INLINE void draw_piece(DepthTiles& tiles, const ReadyTriangles& ready, const Rim& rim, const Piece& piece,
                           const Convex& polygon, float nearest, TileList<1>& list) {
  const TileRange range = tiles_of(tiles, polygon.left, polygon.right, polygon.top, polygon.bottom);
  if (hidden_tiles(tiles, range, nearest)) return;
  if (tiles.margin > 0)
    draw_with_margin(tiles, ready, rim, piece, polygon, range, list);
  else
    list_polygon(tiles, polygon, range, list);
}

HWY_INLINE Convex triangle_of(const ReadyTriangles& ready, int i) {
  Convex out;
  out.left = ready.left[i], out.right = ready.right[i];
  out.top = ready.top[i], out.bottom = ready.bottom[i];
  out.at = ready.at[i], out.across = ready.across[i], out.down = ready.down[i];
  add_edges(ready, i, 3, out);
  return out;
}

// How far apart a quad's halves may lie, of their nearness, before they are drawn one by one.
constexpr float kMostApart = 4e-5f;

// Triangles i and i + 1 as one quad on the first one's plane, moved behind the second's wherever the image
// may hold the quad; false where their planes differ by more than rounding. Whether the answer is true does
// not depend on what is drawn already, for widths of vectors see that at different times.
HWY_INLINE bool make_quad(const DepthTiles& tiles, const ReadyTriangles& ready, int i, Convex& out) {
  out.left = std::min(ready.left[i], ready.left[i + 1]);
  out.right = std::max(ready.right[i], ready.right[i + 1]);
  out.top = std::min(ready.top[i], ready.top[i + 1]);
  out.bottom = std::max(ready.bottom[i], ready.bottom[i + 1]);
  out.across = ready.across[i], out.down = ready.down[i];
  const float across = out.across - ready.across[i + 1], down = out.down - ready.down[i + 1];
  const float x0 = std::max(out.left, 0.0f), x1 = std::min(out.right, static_cast<float>(tiles.width)),
              y0 = std::max(out.top, 0.0f), y1 = std::min(out.bottom, static_cast<float>(tiles.height));
  const float apart = ready.at[i] - ready.at[i + 1];
  const float before = apart + std::max(across * x0, across * x1) + std::max(down * y0, down * y1),
              behind = -apart - std::min(across * x0, across * x1) - std::min(down * y0, down * y1);
  const float rounding =
      kQuadRounding * (std::fabs(ready.at[i]) + std::fabs(out.across) * x1 + std::fabs(out.down) * y1);
  const float back = std::max(before, 0.0f) + rounding;
  const float most = kMostApart * std::min(std::fabs(ready.nearest[i]), std::fabs(ready.nearest[i + 1]));
  if (!(back + std::max(behind, 0.0f) <= most)) return false;
  out.at = ready.at[i] - back;
  add_edges(ready, i, 2, out);
  add_edges(ready, i + 1, 2, out);
  return true;
}

// Where triangle i, which the near plane cuts, is to be drawn tight.
HWY_INLINE std::array<SeamLine, 3> seams_of(const ReadyTriangles& ready, std::size_t i) {
  std::array<SeamLine, 3> out;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(ready.seam[k] >> i & 1)) continue;
    const bool whole = ready.whole[k] >> i & 1;
    const bool on_right = ready.on_right[k] >> i & 1;
    out[k] = {whole ? SeamLine::Kind::given : SeamLine::Kind::through_near,
              on_right ? ready.right_at[k][i] : ready.left_at[k][i], ready.slope[k][i]};
  }
  return out;
}

// Triangle i, which the near plane cuts. Where a pixel's margin counts, first what it shares with others, as
// draw_with_margin() has it.
HWY_NOINLINE void draw_cut(DepthTiles& tiles, const OccluderTopology& mesh, const RowTransform& transform,
                           std::size_t group, const ReadyTriangles& ready, const Rim& rim, std::size_t i) {
  const ExactCorners corners = exact_corners(tiles.projection, mesh, transform, group, i);
  const float way = mesh.groups[group].one_sided >> i & 1 ? tiles.mesh->front : 0;
  if (tiles.margin == 0) return draw_clipped_triangle(tiles, corners, way, {seams_of(ready, i), {}, 0});
  Convex image;
  image.right = static_cast<float>(tiles.width), image.bottom = static_cast<float>(tiles.height);
  Bands bands;
  const bool known = bands_in(rim, 1u << i, image, bands);
  if (known) draw_clipped_triangle(tiles, corners, way, {seams_of(ready, i), bands, rim.slant[i]});
  if (!known || bands.count > 0 || rim.slant[i] > tiles.mesh->slant[group * kGroup + i])
    draw_clipped_triangle(tiles, corners, way, {});
}

HWY_INLINE void draw_group(DepthTiles& tiles, const OccluderTopology& mesh, const RowTransform& transform,
                           std::size_t group, TileList<1>& list) {
  ReadyTriangles ready;
  if (tiles.margin > 0) prefetch_rim(mesh, group);
  for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(F()))
    set_up(tiles, mesh, transform, group, lane, ready);
  if ((ready.drawn | ready.cut) == 0) return;
  Rim rim;
  if (tiles.margin > 0) find_rim(tiles, mesh, transform, group, ready.drawn | ready.cut, rim);
  const std::uint32_t alike = ready.sound & ready.sound >> 1 & ~(ready.to_right ^ ready.to_right >> 1) &
                              ~(ready.flat | ready.flat >> 1);
  const auto draw = [&](const Piece& piece, const Convex& polygon, float nearest)
                        HWY_ATTR { draw_piece(tiles, ready, rim, piece, polygon, nearest, list); };
  std::uint32_t rest = ready.drawn;
  for (std::uint32_t halves = mesh.groups[group].first_half & alike & (rest | rest >> 1); halves != 0;
       halves &= halves - 1) {
    const int i = std::countr_zero(halves);
    Convex quad;
    if (!make_quad(tiles, ready, i, quad)) continue;
    draw({static_cast<std::size_t>(i), 2}, quad, std::max(ready.nearest[i], ready.nearest[i + 1]));
    rest &= ~(3u << i);
  }
  for (; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    draw({static_cast<std::size_t>(i), 1}, triangle_of(ready, i), ready.nearest[i]);
  }
  for (rest = ready.cut; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    draw_cut(tiles, mesh, transform, group, ready, rim, i);
  }
}

HWY_INLINE void prefetch_group(const OccluderTopology& mesh, std::size_t group) {
  hwy::Prefetch(&mesh.groups[group]);
  for (std::size_t i = 0; i < 9; ++i) hwy::Prefetch(&mesh.corners[(group * 9 + i) * kGroup]);
  for (std::size_t i = 0; i < 3; ++i) hwy::Prefetch(&mesh.neighbour[(group * 3 + i) * kGroup]);
}

constexpr std::size_t kGroupsAtOnce = 16;  // as many boxes are asked for together

// Pays for a group whose box stands at `place`. What is left out hides nothing, and leaves the seams beside
// it as true as they are: the mesh goes on there.
inline bool affords_group(const DepthTiles& tiles, std::size_t place, const Projector& projector,
                          MeshBudget& budget) {
  const auto& box = tiles.mesh->box;
  const auto half = [&](std::size_t axis) { return 0.5f * (box[axis + 3][place] - box[axis][place]); };
  const Vec3 size{half(0), half(1), half(2)};
  const Sphere around{{box[0][place] + size.x, box[1][place] + size.y, box[2][place] + size.z},
                      std::sqrt(size.x * size.x + size.y * size.y + size.z * size.z)};
  const float image = projector.width * projector.height;
  const double in_tiles = double{std::min(projected_area(projector, around), image)} / (kTile * kTile);
  return budget.pay(static_cast<double>(kGroup) * budget.triangle +
                    (in_tiles / (tiles.scale * tiles.scale) + 1) * budget.tile);
}

void draw_triangles(DepthTiles& tiles, const OccluderTopology& mesh, const RowTransform& transform,
                    MeshBudget* budget) {
  if (budget && !budget->pay(static_cast<double>(mesh.groups.size()) * budget->look)) return;
  const Projector projector = budget ? make_projector(tiles.view.view, {}) : Projector{};
  find_groups(tiles, mesh, transform);
  const MeshScratch& s = *tiles.mesh;
  TileList<1> list;
  for (std::size_t first = 0; first < s.near_first.size(); first += kGroupsAtOnce) {
    const std::size_t count = std::min(kGroupsAtOnce, s.near_first.size() - first);
    if (budget && !budget->pay(static_cast<double>(count) * budget->query)) return;
    const auto place = [&](std::size_t i) { return static_cast<std::uint32_t>(s.near_first[first + i]); };
    std::array<std::array<float, kGroupsAtOnce>, 6> box;
    for (std::size_t side = 0; side < 6; ++side) {
      for (std::size_t i = 0; i < count; ++i) box[side][i] = s.box[side][place(i)];
    }
    std::array<std::uint8_t, kGroupsAtOnce> visible;
    query_boxes(
        tiles, tiles.projection,
        {box[0].data(), box[1].data(), box[2].data(), box[3].data(), box[4].data(), box[5].data(), count},
        visible.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (budget && visible[i]) visible[i] = affords_group(tiles, place(i), projector, *budget);
      if (visible[i]) prefetch_group(mesh, s.group[place(i)]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (visible[i]) draw_group(tiles, mesh, transform, s.group[place(i)], list);
    }
    draw_listed(tiles, list);
  }
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(draw_triangles);

namespace {

// Whether triangles turn the other way once they are moved so.
bool mirrors(const RowTransform& transform) {
  const auto row = [&](std::size_t a) {
    const Vec4& r = transform.rows[a];
    return glm::dvec3(r.x, r.y, r.z);
  };
  return glm::dot(row(0), glm::cross(row(1), row(2))) < 0;
}

// For meshes of that many groups, one of which is drawn.
void make_ready(MeshScratch& s, std::size_t groups, float front) {
  if (s.known.size() < groups) {
    for (auto& side : s.box) side.resize(groups);
    s.group.reserve(groups), s.near_first.reserve(groups), s.other.reserve(groups);
    s.facing.resize(groups * OccluderTopology::kGroup);
    s.slant.resize(groups * OccluderTopology::kGroup);
    s.known.resize(groups, s.turn);
  }
  s.front = front;
  if (++s.turn == 0) std::fill(s.known.begin(), s.known.end(), 0), s.turn = 1;
}

float front_of(const DepthTiles& tiles, const RowTransform& transform) {
  return tiles.rays.turns_right != mirrors(transform) ? 1.0f : -1.0f;
}

// A mesh that jobs draw, a band of the image each: no pixel is written by two, and what one holds does not
// depend on what others do. More and thinner bands would share out evenly what more of them have to set up.
struct MeshBands {
  const DepthTiles& tiles;
  std::span<MeshScratch> scratch;  // one a job
  const OccluderTopology& mesh;
  const RowTransform& transform;

  void draw(std::uint32_t job) const {
    const auto count = static_cast<std::uint32_t>(scratch.size());
    DepthTiles band = tiles;
    band.mesh = &scratch[job];
    band.first_row = job * tiles.rows / count * kTile;
    band.end_row = std::min(tiles.height, (job + 1) * tiles.rows / count * kTile);
    HWY_DYNAMIC_DISPATCH(draw_triangles)(band, mesh, transform, nullptr);
  }
};

constexpr std::uint32_t kLeastRows = 6;  // of tiles; a thinner band is not worth a job

}  // namespace

void draw_mesh(DepthTiles& tiles, const OccluderTopology& mesh, const RowTransform& transform,
               MeshBudget& budget) {
  make_ready(*tiles.mesh, mesh.groups.size(), front_of(tiles, transform));
  HWY_DYNAMIC_DISPATCH(draw_triangles)(tiles, mesh, transform, &budget);
}

void draw_mesh(DepthTiles& tiles, TileMemory& memory, const OccluderTopology& mesh,
               const RowTransform& transform, const JobSystem& jobs) {
  const std::uint32_t most = std::min(std::min(jobs.threads, kMaxJobs), tiles.rows / kLeastRows);
  const std::uint32_t count = jobs.run ? std::max(1u, most) : 1;
  if (memory.scratch.size() < count) memory.scratch.resize(count), tiles.mesh = memory.scratch.data();
  const std::span scratch = std::span(memory.scratch).first(count);
  for (MeshScratch& s : scratch) make_ready(s, mesh.groups.size(), front_of(tiles, transform));
  if (count == 1) return HWY_DYNAMIC_DISPATCH(draw_triangles)(tiles, mesh, transform, nullptr);
  MeshBands bands{tiles, scratch, mesh, transform};
  jobs.run(
      jobs.user, count, [](void* data, std::uint32_t job) { static_cast<MeshBands*>(data)->draw(job); },
      &bands);
}

}  // namespace sightline::occlusion
#endif
