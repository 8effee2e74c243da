// A mesh's triangles made ready to be drawn, a vector at a time, for every SIMD width. Included by files that
// foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_MESH_SETUP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_MESH_SETUP_INL
#undef SIGHTLINE_OCCLUSION_MESH_SETUP_INL
#else
#define SIGHTLINE_OCCLUSION_MESH_SETUP_INL
#endif

#include "library/occlusion/mesh_facing-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// A group of triangles, ready to be drawn.
struct ReadyTriangles {
  alignas(64) std::array<float, 16> left, right, top, bottom, nearest, at, across, down, inset;
  alignas(64) std::array<std::array<float, 16>, 3> slope, left_at, right_at;  // as Convex has them
  std::array<std::uint32_t, 3> on_right{}, on_left{};  // a bit a triangle: the edge bounds it there
  // Where triangles make polygons.
  alignas(64) std::array<float, 16> doubt, distance, sides;  // as TrianglePlanes has them
  alignas(64) std::array<std::array<float, 16>, 3> y;  // of the corners; where a polygon goes straight on
  std::uint32_t drawn = 0, cut = 0;
  std::array<std::uint32_t, 3> seam{}, whole{};  // drawn tight; of cut ones, before the near plane end to end
  // Have a plane and turn one way; to the right; have an outer edge that is flat on the image.
  std::uint32_t sound = 0, to_right = 0, flat = 0;
};

// Leaves those with no pixel centre between their sides within the image, and those behind the tiles of their
// corners where those are all. False where none remains.
HWY_INLINE bool keep_those_that_show(const DepthTiles& tiles, Candidates& c) {
  const F f;
  const PixelBounds bounds = pixel_bounds(tiles, c.outline);
  c.drawn = hn::And(c.drawn, bounds.some);
  if (hn::AllFalse(f, c.drawn)) return false;
  find_nearness(tiles.projection, c);
  const PixelRanges ranges = pixel_ranges(bounds, c.drawn);
  const auto before = hn::Lt(least_at_corners(tiles, tiles.farthest, ranges), c.nearest);
  c.drawn = hn::And(c.drawn, hn::Or(hn::RebindMask(f, ranges.many), before));
  return !hn::AllFalse(f, c.drawn);
}

HWY_INLINE void set_planes(const DepthTiles& tiles, const OccluderTopology& mesh,
                           const TrianglePlanes& planes, Candidates& c, ReadyTriangles& out) {
  const F f;
  const auto& [at, across, down, doubt, distance, sides, sound] = planes;
  c.drawn = hn::And(c.drawn, sound);
  out.sound |= bits_of(f, sound) << c.lane;
  hn::Store(hn::Sub(moved_back(tiles, at, across, down, c.nearest), doubt), f, &out.at[c.lane]);
  hn::Store(across, f, &out.across[c.lane]);
  hn::Store(down, f, &out.down[c.lane]);
  if (mesh.groups[c.group].follows != 0) {
    hn::Store(doubt, f, &out.doubt[c.lane]);
    hn::Store(distance, f, &out.distance[c.lane]);
    hn::Store(sides, f, &out.sides[c.lane]);
  }
  hn::Store(c.nearest, f, &out.nearest[c.lane]);
}

// An edge of each triangle, from a to b.
struct Edges {
  VF ax, ay, bx, by;
};

// From the vertex nearer the image's middle, where rounding is least; of two as near, from that of lower
// number: both sides of a seam compute the same bits.
HWY_INLINE Edges edges_of(const DepthTiles& tiles, const OccluderTopology& mesh, const Candidates& c,
                          std::size_t k) {
  const F f;
  const auto from_middle = [&](VF x, VF y) HWY_ATTR {
    return hn::Add(hn::Abs(hn::Sub(x, hn::Set(f, 0.5f * static_cast<float>(tiles.width)))),
                   hn::Abs(hn::Sub(y, hn::Set(f, 0.5f * static_cast<float>(tiles.height)))));
  };
  const std::size_t next = (k + 1) % 3;
  const VF *x = c.image.x, *y = c.image.y;
  const VF here = from_middle(x[k], y[k]), there = from_middle(x[next], y[next]);
  const auto higher_first = mask_of(f, std::uint64_t{mesh.groups[c.group].turned[k]} >> c.lane);
  const auto turned = hn::Or(hn::Lt(there, here), hn::And(hn::Eq(there, here), higher_first));
  return {hn::IfThenElse(turned, x[next], x[k]), hn::IfThenElse(turned, y[next], y[k]),
          hn::IfThenElse(turned, x[k], x[next]), hn::IfThenElse(turned, y[k], y[next])};
}

// Which way the neighbours at edge k turn on the image, as facing_of() says; where there is none, 0. From
// what the group itself holds of them, so that no other needs to be looked at.
HWY_INLINE VF facing_beyond(const DepthTiles& tiles, const OccluderTopology& mesh, const Candidates& c,
                            std::size_t k) {
  const F f;
  const EyeProjection& e = tiles.projection;
  const std::size_t next = (k + 1) % 3;
  const float* from = &mesh.beyond[(c.group * 9 + 3 * k) * kGroup + c.lane];
  const VPoints p{hn::Load(f, from), hn::Load(f, from + kGroup), hn::Load(f, from + 2 * kGroup)};
  const Corners corners{c.corners[next], c.corners[k], about_eye(e, p)};
  const VF over_w = hn::Div(hn::Set(f, 1.0f), dot_row(e.w, corners[2]));
  OnImage image;
  image.x[0] = c.image.x[next], image.x[1] = c.image.x[k];
  image.y[0] = c.image.y[next], image.y[1] = c.image.y[k];
  image.x[2] = hn::Mul(dot_row(e.x, corners[2]), over_w),
  image.y[2] = hn::Mul(dot_row(e.y, corners[2]), over_w);
  return facing_of(tiles, corners, image, {c.before[next], c.before[k], before_near(tiles, corners[2])},
                   mesh.groups[c.group].one_sided_beyond[k] >> c.lane);
}

// The same as far as they count where a pixel's margin does. Facings are known.
HWY_INLINE VF counted_beyond(const DepthTiles& tiles, const OccluderTopology& mesh, const Candidates& c,
                             std::size_t k) {
  const F f;
  const I i32;
  const VI other = hn::Load(i32, &mesh.neighbour[(c.group * 3 + k) * kGroup + c.lane]);
  const auto some = hn::RebindMask(f, hn::Gt(other, hn::Set(i32, -1)));
  return hn::IfThenElseZero(some,
                            hn::GatherIndex(f, tiles.mesh->facing.data(), hn::Max(other, hn::Zero(i32))));
}

// Edge k of each triangle, moved inwards by `inset` where no other triangle that turns the same way goes on
// there; what bounds the rows narrows `outline`.
HWY_INLINE void set_edge(const DepthTiles& tiles, const OccluderTopology& mesh, const Candidates& c,
                         std::size_t k, VF inset, std::uint32_t shared, Rectangles& outline,
                         ReadyTriangles& out) {
  const F f;
  const VF* y = c.image.y;
  if (mesh.groups[c.group].straight != 0) hn::Store(y[k], f, &out.y[k][c.lane]);
  const VF others = tiles.margin > 0 ? counted_beyond(tiles, mesh, c, k) : facing_beyond(tiles, mesh, c, k);
  const auto seam = hn::Or(hn::Gt(hn::Mul(others, c.facing), hn::Zero(f)), mask_of(f, shared));
  out.seam[k] |= bits_of(f, seam) << c.lane;
  const auto falls = hn::Gt(y[(k + 1) % 3], y[k]);
  const auto on_right = hn::Not(hn::Xor(falls, hn::Gt(c.facing, hn::Zero(f))));
  const auto [ax, ay, bx, by] = edges_of(tiles, mesh, c, k);
  const VF rise = hn::Sub(by, ay), slope = hn::Div(hn::Sub(bx, ax), rise),
           at = hn::Sub(ax, hn::Mul(ay, slope));
  const VF inwards = hn::Mul(hn::IfThenZeroElse(seam, inset), hn::Add(hn::Set(f, 1.0f), hn::Abs(slope)));
  const auto steep = hn::Ge(hn::Abs(rise), hn::Set(f, kFlatEdge));
  const auto at_right = hn::And(steep, on_right), at_left = hn::AndNot(on_right, steep);
  const VF far = hn::Set(f, kInfinity);
  out.on_right[k] |= bits_of(f, at_right) << c.lane;
  out.on_left[k] |= bits_of(f, at_left) << c.lane;
  hn::Store(hn::IfThenElseZero(steep, slope), f, &out.slope[k][c.lane]);
  hn::Store(inset, f, &out.inset[c.lane]);
  hn::Store(hn::IfThenElse(at_right, hn::Sub(at, inwards), far), f, &out.right_at[k][c.lane]);
  hn::Store(hn::IfThenElse(at_left, hn::Add(at, inwards), hn::Neg(far)), f, &out.left_at[k][c.lane]);
  // A flat edge that is no seam bounds the rows.
  const auto bounds = hn::AndNot(seam, hn::Not(steep));
  out.flat |= bits_of(f, bounds) << c.lane;
  const auto above = hn::Gt(y[(k + 2) % 3], ay);
  const VF top = hn::Max(outline.top, hn::Add(hn::Max(ay, by), inset)),
           bottom = hn::Min(outline.bottom, hn::Sub(hn::Min(ay, by), inset));
  outline.top = hn::IfThenElse(hn::And(bounds, above), top, outline.top);
  outline.bottom = hn::IfThenElse(hn::AndNot(above, bounds), bottom, outline.bottom);
}

// The edges of cut triangles that lie before the near plane from end to end.
HWY_INLINE void set_whole_edges(const Candidates& c, ReadyTriangles& out) {
  const F f;
  for (std::size_t k = 0; k < 3; ++k)
    out.whole[k] |= bits_of(f, hn::And(c.before[k], c.before[(k + 1) % 3])) << c.lane;
}

// Whether others go on all along an edge that has more than one or a row of them. Facings are known.
HWY_NOINLINE inline bool goes_on_along(const DepthTiles& tiles, const OccluderTopology& mesh,
                                       const OccluderTopology::SharedEdge& edge) {
  const float* facing = tiles.mesh->facing.data();
  const float turns = facing[edge.triangle];
  bool all = true, piece = false;
  for (std::uint32_t o = edge.first; o < edge.end && all; ++o) {
    const std::uint32_t other = mesh.others[o];
    const float turn = turns * facing[other / 4];
    piece = piece || (other & 2 ? turn < 0 : turn > 0);
    if (other & 1) all = piece, piece = false;
  }
  return all;
}

// Of a group's edges of that kind, those where others go on all along; a bit a triangle and edge.
inline std::array<std::uint32_t, 3> shared_seams(const DepthTiles& tiles, const OccluderTopology& mesh,
                                                 std::size_t group) {
  std::array<std::uint32_t, 3> out{};
  for (std::uint32_t i = mesh.groups[group].first_shared; i < mesh.groups[group].end_shared; ++i) {
    const OccluderTopology::SharedEdge& edge = mesh.shared[i];
    out[edge.edge] |= std::uint32_t{goes_on_along(tiles, mesh, edge)} << edge.triangle % kGroup;
  }
  return out;
}

// A vector of a group's triangles, and their planes where some of the group are drawn.
HWY_INLINE void set_up(const DepthTiles& tiles, const OccluderTopology& mesh, Candidates& c,
                       const TrianglePlanes* planes, const std::array<std::uint32_t, 3>& shared,
                       ReadyTriangles& out) {
  const F f;
  if (planes) set_planes(tiles, mesh, *planes, c, out);
  out.to_right |= bits_of(f, hn::Gt(c.facing, hn::Zero(f))) << c.lane;
  const VF inset = inset_of(tiles, widest_of(c.outline));
  Rectangles outline = c.outline;
  for (std::size_t k = 0; k < 3; ++k) set_edge(tiles, mesh, c, k, inset, shared[k] >> c.lane, outline, out);
  if ((out.cut >> c.lane & ((1u << hn::Lanes(f)) - 1)) != 0) set_whole_edges(c, out);
  // Where only seams bound a corner of the outline, rounding may carry them beyond it.
  store(outline, out, c.lane);
  out.drawn |= bits_of(f, c.drawn) << c.lane;
}

// The triangles of a group. All or none are set up, however many a vector holds: whether they are drawn as
// polygons does not depend on that.
HWY_INLINE void set_up(DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group,
                       ReadyTriangles& out) {
  const F f;
  constexpr std::size_t kVectors = kGroup / hn::MaxLanes(F());
  const std::size_t lanes = hn::Lanes(f);
  std::array<Candidates, kVectors> vectors;
  std::array<TrianglePlanes, kVectors> planes;
  const VF exact = hn::Zero(f);
  bool some = false;
  for (std::size_t v = 0; v * lanes < kGroup; ++v) {
    Candidates& c = vectors[v] = candidates_of(tiles, mesh, group, v * lanes);
    std::uint32_t cut = bits_of(f, hn::Eq(hn::Abs(c.facing), hn::Set(f, kCut)));
    if (cut != 0) cut &= ~beyond_a_side(tiles, c.corners, {exact, exact, exact});
    out.cut |= cut << c.lane;
    some |= keep_those_that_show(tiles, c);
  }
  if (!some && out.cut == 0) return;
  const OccluderTopology::Group& its = mesh.groups[group];
  const bool margin = tiles.margin > 0;
  for (std::size_t v = 0; (some || margin) && v * lanes < kGroup; ++v) {
    if (hn::AllFalse(f, vectors[v].drawn)) find_nearness(tiles.projection, vectors[v]);
    planes[v] = planes_of(tiles, vectors[v]);
  }
  if (margin)
    know_facing(tiles, mesh, group, vectors, planes);
  else if (its.first_shared < its.end_shared)
    know_facing(tiles, mesh, group);
  know_around(tiles, mesh, group);
  const std::array<std::uint32_t, 3> shared = shared_seams(tiles, mesh, group);
  for (std::size_t v = 0; v * lanes < kGroup; ++v)
    set_up(tiles, mesh, vectors[v], some ? &planes[v] : nullptr, shared, out);
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
