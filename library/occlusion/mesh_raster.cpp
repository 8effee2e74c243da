// Triangles of meshes into the tiles.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include "library/geometry/error_bounds.hpp"
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

// Of a group of triangles those that are drawn as one polygon, and a bit a triangle and edge within it.
struct Piece {
  std::size_t first, count;
  std::array<std::uint32_t, 3> inner{};

  [[nodiscard]] std::uint32_t bits() const { return ((1u << count) - 1) << first; }
  // edge(triangle, k) for each edge of the polygon.
  template <class Visit>
  HWY_INLINE void for_edges(const Visit& edge) const {
    std::uint64_t outer = 0;  // one loop, whose end is hard to guess, rather than three
    for (std::size_t k = 0; k < 3; ++k) outer |= std::uint64_t{bits() & ~inner[k]} << kGroup * k;
    for (; outer != 0; outer &= outer - 1) {
      const auto at = static_cast<std::size_t>(std::countr_zero(outer));
      edge(at % kGroup, at / kGroup);
    }
  }
};

// The least and the most of a piece's triangles. Which one has it is hard to guess, so nothing branches on
// that.
HWY_INLINE float least_of(const Piece& piece, const std::array<float, 16>& values) {
  float out = values[piece.first];
  for (std::size_t i = 1; i < piece.count; ++i) out = std::min(out, values[piece.first + i]);
  return out;
}
HWY_INLINE float most_of(const Piece& piece, const std::array<float, 16>& values) {
  float out = values[piece.first];
  for (std::size_t i = 1; i < piece.count; ++i) out = std::max(out, values[piece.first + i]);
  return out;
}

// Of the group the piece that triangle i leads.
HWY_INLINE Piece piece_at(const OccluderTopology::Group& group, std::size_t i) {
  return {i, 1 + static_cast<std::size_t>(std::countr_one(group.follows >> (i + 1))), group.inner};
}

// Adds edge k of triangle i. What bounds its own lines alone does so where it ends at a corner beside it,
// too, if it is to be kept away from.
HWY_INLINE void add_edge(const ReadyTriangles& ready, std::size_t i, std::size_t k, Convex& out) {
  out.slope[out.edges] = ready.slope[k][i];
  out.left_at[out.edges] = ready.left_at[k][i];
  out.right_at[out.edges] = ready.right_at[k][i];
  if (out.by_lines) {
    const float a = ready.y[k][i], b = ready.y[(k + 1) % 3][i],
                away = ready.seam[k] >> i & 1 ? 0 : ready.inset[i];
    out.from[out.edges] = std::min(a, b) - away, out.to[out.edges] = std::max(a, b) + away;
  }
  ++out.edges;
  out.has_left |= ready.on_left[k] >> i & 1, out.has_right |= ready.on_right[k] >> i & 1;
}

// Moves the edges of a piece inwards that are drawn tight, as if nothing went on there.
HWY_NOINLINE Convex inset_piece(const ReadyTriangles& ready, const Piece& piece, Convex tight) {
  const float inset = most_of(piece, ready.inset);
  tight.left += inset, tight.right -= inset, tight.top += inset, tight.bottom -= inset;
  tight.edges = 0;
  piece.for_edges([&](std::size_t i, std::size_t k) {
    const std::size_t at = tight.edges;
    add_edge(ready, i, k, tight);
    if (!(ready.seam[k] >> i & 1)) return;
    const float inwards = inset * (1 + std::fabs(tight.slope[at]));
    tight.left_at[at] += inwards, tight.right_at[at] -= inwards;
    if (tight.by_lines) tight.from[at] -= inset, tight.to[at] += inset;
  });
  return tight;
}

// Where a pixel's margin counts. First the pixels that are the piece's own; then those that it shares with
// others, as deep as the deepest of them may be there.
HWY_NOINLINE void draw_with_margin(DepthTiles& tiles, const ReadyTriangles& ready, const Rim& rim,
                                   const Piece& piece, const Convex& tight, const TileRange& range,
                                   TileList<1>& list) {
  const float deeper = deeper_by(tiles, tight, most_of(piece, rim.slant));
  const bool again = is_much_deeper(tiles, tight, deeper);
  Bands bands;
  const bool known = bands_in(rim, piece.bits(), tight, bands);
  Convex shared = tight;
  shared.at -= deeper;
  if (known && !again && bands.count == 0) return list_polygon(tiles, shared, range, list);
  const Convex middle = inset_piece(ready, piece, tight);
  if (!known || again) list_polygon(tiles, middle, range, list);
  if (known) list_polygon(tiles, shared, range, bands, middle, again, list);
}

HWY_INLINE void draw_piece(DepthTiles& tiles, const ReadyTriangles& ready, const Rim& rim, const Piece& piece,
                           const Convex& polygon, float nearest, MeshBudget* budget, TileList<1>& list) {
  const TileRange range = tiles_of(tiles, polygon.left, polygon.right, polygon.top, polygon.bottom);
  if (hidden_tiles(tiles, range, nearest)) return;
  if (budget && !budget->pay(budget->polygon + range.count() * budget->tile)) return;
  tiles.mesh->note_cost(range.begin_y, range.end_y, range.end_x - range.begin_x);
  if (tiles.margin > 0)
    draw_with_margin(tiles, ready, rim, piece, polygon, range, list);
  else
    list_polygon(tiles, polygon, range, list);
}

HWY_INLINE Convex triangle_of(const ReadyTriangles& ready, std::size_t i) {
  Convex out;
  out.left = ready.left[i], out.right = ready.right[i];
  out.top = ready.top[i], out.bottom = ready.bottom[i];
  out.at = ready.at[i], out.across = ready.across[i], out.down = ready.down[i];
  for (std::size_t k = 0; k < 3; ++k) add_edge(ready, i, k, out);
  return out;
}

// Whether a piece's triangles all have a plane and turn one way, and each edge of it bounds it to a side, or,
// where edges bound more than their own lines, its rows.
HWY_INLINE bool makes_one(const ReadyTriangles& ready, const Piece& piece, bool by_lines) {
  const std::uint32_t its = piece.bits(), to_right = ready.to_right & its;
  if ((ready.sound & its) != its || (to_right != 0 && to_right != its)) return false;
  if (!by_lines) return (ready.flat & its) == 0;
  std::uint32_t flat = 0;
  for (std::size_t k = 0; k < 3; ++k) flat |= ~(ready.on_left[k] | ready.on_right[k] | piece.inner[k]);
  return (flat & its) == 0;
}

// How far apart a polygon and its plane may lie, of the eye's distance, before its triangles are drawn one by
// one.
constexpr float kMostApart = 4e-5f;
static_assert(OccluderTopology::kMostSides <= Convex::kMaxEdges);

// Moves a polygon's plane, its first triangle's, behind all of it: triangles lie up to `apart` from the
// plane, and reach farther than the first, for whose corners its rounding is known. False where that is too
// far.
HWY_INLINE bool move_behind(const DepthTiles& tiles, const ReadyTriangles& ready, const Piece& piece,
                            float apart, float nearest, Convex& out) {
  const bool orthographic = tiles.projection.orthographic;
  const std::size_t first = piece.first;
  const float away = kPolygonApart * apart / ready.distance[first];
  if (!(away <= kMostApart)) return false;
  const auto sides = std::span(ready.sides).subspan(first, piece.count);
  const float farther = orthographic ? std::accumulate(sides.begin(), sides.end(), 0.0f) / sides[0]
                                     : nearest / ready.nearest[first],
              nearer = std::fabs(nearest) - std::fabs(ready.nearest[first]);
  out.at = ready.at[first] -
           ((orthographic ? 1 : nearest) * away + (farther - 1) * ready.doubt[first] +
            kNearnessRounding * std::max(nearer, 0.0f) + kPolygonRounding * std::fabs(ready.at[first]));
  return true;
}

// A piece as one polygon, unless a plane or a side of it is unsure. Whether the answer is true does not
// depend on what is drawn already, for widths of vectors see that at different times.
HWY_NOINLINE bool make_polygon(const DepthTiles& tiles, const ReadyTriangles& ready, const Piece& piece,
                               bool by_lines, float apart, Convex& out, float& nearest) {
  if (!makes_one(ready, piece, by_lines)) return false;
  nearest = most_of(piece, ready.nearest);
  if (!move_behind(tiles, ready, piece, apart, nearest, out)) return false;
  out.across = ready.across[piece.first], out.down = ready.down[piece.first];
  out.left = least_of(piece, ready.left), out.right = most_of(piece, ready.right);
  out.top = least_of(piece, ready.top), out.bottom = most_of(piece, ready.bottom);
  out.by_lines = by_lines;
  piece.for_edges([&](std::size_t i, std::size_t k) { add_edge(ready, i, k, out); });
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

// Triangle i, which the near plane cuts. Returns how many tiles lie around it.
HWY_NOINLINE std::uint32_t draw_cut(DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group,
                                    const ReadyTriangles& ready, const Rim& rim, std::size_t i) {
  const ExactCorners corners = exact_corners(tiles.projection, mesh, group, i);
  const float way = mesh.groups[group].one_sided >> i & 1 ? tiles.mesh->front : 0;
  if (tiles.margin == 0) return draw_clipped_triangle(tiles, corners, way, {seams_of(ready, i), {}, 0});
  Convex image;
  image.right = static_cast<float>(tiles.width), image.bottom = static_cast<float>(tiles.height);
  Bands bands;
  if (!bands_in(rim, 1u << i, image, bands)) return draw_clipped_triangle(tiles, corners, way, {});
  return draw_clipped_triangle(tiles, corners, way, {seams_of(ready, i), bands, rim.slant[i]});
}

// The triangles that are drawn, and those of their pieces that do not show themselves in this band of the
// image: what lies around a piece must not depend on bands.
HWY_INLINE std::uint32_t whole_pieces(const OccluderTopology::Group& group, const ReadyTriangles& ready) {
  std::uint32_t out = ready.drawn;
  for (std::uint32_t leads = group.follows >> 1 & ~group.follows; leads != 0; leads &= leads - 1) {
    const Piece piece = piece_at(group, static_cast<std::size_t>(std::countr_zero(leads)));
    if ((ready.drawn & piece.bits()) != 0) out |= piece.bits();
  }
  return out;
}

// What a budget does not pay for is left out, and hides nothing; seams beside it stay as true as they are:
// the mesh goes on there.
HWY_INLINE void draw_group(DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group,
                           MeshBudget* budget, TileList<1>& list) {
  ReadyTriangles ready;
  if (tiles.margin > 0) prefetch_rim(mesh, group);
  set_up(tiles, mesh, group, ready);
  if ((ready.drawn | ready.cut) == 0) return;
  Rim rim;
  if (tiles.margin > 0)
    find_rim(tiles, mesh, group, whole_pieces(mesh.groups[group], ready) | ready.cut, rim);
  const OccluderTopology::Group& its = mesh.groups[group];
  const auto draw = [&](const Piece& piece, const Convex& polygon, float nearest)
                        HWY_ATTR { draw_piece(tiles, ready, rim, piece, polygon, nearest, budget, list); };
  std::uint32_t rest = ready.drawn;
  for (std::uint32_t leads = its.follows >> 1 & ~its.follows; leads != 0; leads &= leads - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(leads));
    const Piece piece = piece_at(its, i);
    if ((rest & piece.bits()) == 0) continue;
    Convex polygon;
    float nearest = 0;
    if (!make_polygon(tiles, ready, piece, its.straight >> i & 1, its.apart, polygon, nearest)) continue;
    draw(piece, polygon, nearest);
    rest &= ~piece.bits();
  }
  for (; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    draw({i, 1}, triangle_of(ready, i), ready.nearest[i]);
  }
  for (rest = ready.cut; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    // How much of the image it covers shows once it is clipped.
    if (budget && !budget->affords(budget->polygon + tiles.columns * tiles.rows * budget->tile)) break;
    const std::uint32_t around = draw_cut(tiles, mesh, group, ready, rim, i);
    if (budget) budget->pay(budget->polygon + around * budget->tile);
  }
}

HWY_INLINE void prefetch_group(const OccluderTopology& mesh, std::size_t group) {
  hwy::Prefetch(&mesh.groups[group]);
  prefetch_corners(mesh, group);
  for (std::size_t i = 0; i < 9; ++i) hwy::Prefetch(&mesh.beyond[(group * 9 + i) * kGroup]);
}

constexpr std::size_t kGroupsAtOnce = 16;  // as many boxes are asked for together

void draw_triangles(DepthTiles& tiles, const OccluderTopology& mesh, MeshBudget* budget) {
  if (budget && !budget->pay(static_cast<double>(mesh.groups.size()) * budget->look)) return;
  find_groups(tiles, mesh);
  const MeshScratch& s = *tiles.mesh;
  TileList<1> list;
  const bool alone = tiles.first_row == 0 && tiles.end_row == tiles.height;
  for (std::size_t first = 0; first < s.in_view; first += kGroupsAtOnce) {
    const std::size_t count = std::min(kGroupsAtOnce, s.in_view - first);
    if (budget && !budget->pay(static_cast<double>(count) * budget->query)) return;
    const std::uint32_t* place = &s.near_first[first];
    const auto group_at = [&](std::size_t i) { return s.group[place[i]]; };
    std::array<std::array<float, kGroupsAtOnce>, 6> box;
    for (std::size_t side = 0; side < 6; ++side) {
      for (std::size_t i = 0; i < count; ++i) box[side][i] = s.box[side][place[i]];
    }
    std::array<std::uint8_t, kGroupsAtOnce> visible;
    query_boxes(tiles, tiles.projection, geometry::span_of(box, count), visible.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (budget && visible[i]) visible[i] = budget->pay(static_cast<double>(kGroup) * budget->triangle);
      if (visible[i]) prefetch_group(mesh, group_at(i));
    }
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (visible[i]) draw_group(tiles, mesh, group_at(i), budget, list), ++drawn;
    }
    draw_listed(tiles, list);
    if (alone) note_drawn(tiles, drawn);
  }
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(draw_triangles);

namespace {

// The tiles as the mesh sees them from where it stands before it is placed, so that no corner is moved.
std::optional<DepthTiles> placed(const DepthTiles& tiles, const ExactAffine& placement) {
  std::optional<DepthTiles> out = tiles;
  if (placement == ExactAffine{}) return out;
  const double inset = place(placement, out->projection, out->rays);
  if (inset == 0) return {};
  if (inset > 1) {
    const auto side = static_cast<float>(std::max(tiles.width, tiles.height));
    out->rounding = static_cast<float>(inset) *
                    std::max(tiles.rounding, geometry::kInset + 2 * geometry::kInsetGrowth * side);
  }
  return out;
}

// For a mesh that is to be drawn.
void make_ready(MeshScratch& s, const DepthTiles& tiles, const OccluderTopology& mesh) {
  const std::size_t groups = mesh.groups.size();
  if (s.known.size() < groups) {
    const std::size_t room = groups + OccluderTopology::kGroup;
    for (auto& side : s.box) side.resize(room);
    for (auto* list : {&s.group, &s.step, &s.near_first}) list->resize(room, 0);
    s.facing.resize(groups * OccluderTopology::kGroup);
    s.slant.resize(groups * OccluderTopology::kGroup);
    s.known.resize(groups, s.turn);
  }
  s.front = tiles.rays.turns_right ? 1.0f : -1.0f;
  if (++s.turn == 0) std::fill(s.known.begin(), s.known.end(), 0), s.turn = 1;
}

// A mesh that jobs draw, a band of the image each: no pixel is written by two, and what one holds does not
// depend on what others do. More and thinner bands would share out evenly what more of them have to set up.
struct MeshBands {
  const DepthTiles& tiles;
  std::span<MeshScratch> scratch;  // one a job
  const OccluderTopology& mesh;
  BandCuts cuts;

  void draw(std::uint32_t job) const {
    DepthTiles band = tiles;
    band.mesh = &scratch[job];
    band.first_row = cuts[job] * kTile;
    band.end_row = std::min(tiles.height, cuts[job + 1] * kTile);
    HWY_DYNAMIC_DISPATCH(draw_triangles)(band, mesh, nullptr);
  }
};

constexpr std::uint32_t kLeastRows = 6;  // of tiles; a thinner band is not worth a job

}  // namespace

void draw_mesh(DepthTiles& tiles, const OccluderTopology& mesh, const ExactAffine& placement,
               MeshBudget* budget) {
  std::optional<DepthTiles> there = placed(tiles, placement);
  if (!there) return;
  make_ready(*there->mesh, *there, mesh);
  HWY_DYNAMIC_DISPATCH(draw_triangles)(*there, mesh, budget);
}

void draw_mesh(DepthTiles& tiles, TileMemory& memory, const OccluderTopology& mesh,
               const ExactAffine& placement, const JobSystem& jobs) {
  const std::uint32_t most = std::min(std::min(jobs.threads, kMaxJobs), tiles.rows / kLeastRows);
  const std::uint32_t count = jobs.run ? std::max(1u, most) : 1;
  if (memory.scratch.size() < count) memory.scratch.resize(count), tiles.mesh = memory.scratch.data();
  const std::span scratch = std::span(memory.scratch).first(count);
  std::optional<DepthTiles> there = placed(tiles, placement);
  if (!there) return;
  for (MeshScratch& s : scratch) make_ready(s, *there, mesh);
  if (count == 1) return HWY_DYNAMIC_DISPATCH(draw_triangles)(*there, mesh, nullptr);
  DrawnMesh& drawn = memory.history.find(*there, mesh);
  if (kSharesByCost)
    for (MeshScratch& s : scratch) s.cost_steps.assign(tiles.rows + 1, 0);
  MeshBands bands{*there, scratch, mesh, drawn.cuts(tiles.rows, count)};
  jobs.run(
      jobs.user, count, [](void* data, std::uint32_t job) { static_cast<MeshBands*>(data)->draw(job); },
      &bands);
  note_drawn(tiles, std::size_t{tiles.columns} * tiles.rows);
  if (!kSharesByCost) return;
  drawn.note(scratch, tiles.rows);
  for (MeshScratch& s : scratch) s.cost_steps.clear();
}

}  // namespace sightline::occlusion
#endif
