// A mesh's triangles made ready to be drawn, a vector at a time, for every SIMD width. Included by files that
// foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_MESH_SETUP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_MESH_SETUP_INL
#undef SIGHTLINE_OCCLUSION_MESH_SETUP_INL
#else
#define SIGHTLINE_OCCLUSION_MESH_SETUP_INL
#endif

#include "library/occlusion/cut_triangle.hpp"
#include "library/occlusion/depth_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

constexpr std::size_t kGroup = OccluderTopology::kGroup;

// A vector of triangles' corners about the eye, from triangle 16·group + lane on.
HWY_INLINE Corners corners_about_eye(const EyeProjection& e, const OccluderTopology& mesh, std::size_t group,
                                     std::size_t lane) {
  const F f;
  Corners out;
  for (std::size_t k = 0; k < 3; ++k) {
    const float* from = &mesh.corners[(group * 9 + 3 * k) * kGroup + lane];
    const VPoints p{hn::Load(f, from), hn::Load(f, from + kGroup), hn::Load(f, from + 2 * kGroup)};
    out[k] = about_eye(e, p);
  }
  return out;
}

// Which way a triangle turns on the image: 1 or -1; 0: too small, or not drawn from this side; kCut times
// that: the near plane cuts it.
constexpr float kCut = 2;

// Which way triangles turn whose image is not known, by the side of their planes that the eye is on; 0 where
// that is unsure.
HWY_INLINE VF turn_by_plane(const DepthTiles& tiles, const Corners& corners) {
  return hn::Mul(side_of_planes(tiles, corners), hn::Set(F(), tiles.rays.turns_right ? 1.0f : -1.0f));
}

// Not a number counts as behind.
HWY_INLINE hn::Mask<F> before_near(const DepthTiles& tiles, const VPoints& corner) {
  return hn::Ge(dot_row(tiles.rays.near_plane, corner), hn::Zero(F()));
}

// Where a pixel's margin counts, a triangle counts that no pixel can reach across, whichever edge it enters
// by: then what a pixel touches of a mesh beside one of its triangles shares a corner with that triangle.
HWY_INLINE hn::Mask<F> wide_enough(const DepthTiles& tiles, const OnImage& image, VF area) {
  const F f;
  VF longest = hn::Zero(f), farthest = longest;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    longest = hn::Max(longest, hn::Add(hn::Abs(hn::Sub(image.x[next], image.x[k])),
                                       hn::Abs(hn::Sub(image.y[next], image.y[k]))));
    farthest = hn::Max(farthest, hn::Max(hn::Abs(image.x[k]), hn::Abs(image.y[k])));
  }
  return hn::Ge(hn::Abs(area), hn::Mul(inset_of(tiles, farthest), longest));
}

// Twice the area from which on it is sure which way a triangle turns.
HWY_INLINE VF least_area(const DepthTiles& tiles, const OnImage& image) {
  const F f;
  const auto from_first = [&](std::size_t k) HWY_ATTR {
    return hn::Add(hn::Abs(hn::Sub(image.x[k], image.x[0])), hn::Abs(hn::Sub(image.y[k], image.y[0])));
  };
  const VF length = hn::Add(from_first(1), from_first(2)),
           farthest = hn::Add(length, hn::Add(hn::Abs(image.x[0]), hn::Abs(image.y[0])));
  const VF rounding = hn::Add(hn::Set(f, tiles.rounding), hn::Mul(hn::Set(f, kCornerRounding), farthest));
  return hn::Max(hn::Set(f, kLeastDrawnArea), hn::Mul(length, rounding));
}

// Which of the corners lie before the near plane.
using Before = std::array<hn::Mask<F>, 3>;

HWY_INLINE Before before_near(const DepthTiles& tiles, const Corners& corners) {
  return {before_near(tiles, corners[0]), before_near(tiles, corners[1]), before_near(tiles, corners[2])};
}

HWY_INLINE VF facing_of(const DepthTiles& tiles, const Corners& corners, const OnImage& image,
                        const Before& before, std::uint32_t one_sided) {
  const F f;
  const VF area = area_of(image);
  const VF zero = hn::Zero(f), one = hn::Set(f, 1.0f), least = least_area(tiles, image);
  VF facing = hn::IfThenElse(hn::Gt(area, least), one,
                             hn::IfThenElse(hn::Lt(area, hn::Neg(least)), hn::Neg(one), zero));
  if (tiles.margin > 0) facing = hn::IfThenElseZero(wide_enough(tiles, image, area), facing);
  const auto& [a, b, c] = before;
  const auto whole = hn::And(hn::And(a, b), c), cut = hn::AndNot(whole, hn::Or(hn::Or(a, b), c));
  facing = hn::IfThenElseZero(whole, facing);
  if (!hn::AllFalse(f, cut))
    facing = hn::IfThenElse(cut, hn::Mul(turn_by_plane(tiles, corners), hn::Set(f, kCut)), facing);
  const auto from_behind =
      hn::And(mask_of(f, one_sided), hn::Lt(hn::Mul(facing, hn::Set(f, tiles.mesh->front)), zero));
  return hn::IfThenZeroElse(from_behind, facing);
}

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

// A vector of triangles on their way to be ready, from triangle 16·group + lane of the mesh on.
struct Candidates {
  std::size_t group, lane;
  Corners corners;
  OnImage image;
  Before before;
  VF facing;
  Rectangles outline;
  hn::Mask<F> drawn;        // as far as is known
  VF nearness[3], nearest;  // found where some are drawn
};

HWY_INLINE Candidates candidates_of(DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group,
                                    std::size_t lane) {
  const F f;
  const EyeProjection& e = tiles.projection;
  Candidates c;
  c.group = group, c.lane = lane;
  c.corners = corners_about_eye(e, mesh, group, lane);
  c.image = on_image(e, c.corners);
  c.before = before_near(tiles, c.corners);
  c.facing = facing_of(tiles, c.corners, c.image, c.before, mesh.groups[group].one_sided >> lane);
  if (hn::Lanes(f) == kGroup && tiles.margin == 0) {
    hn::Store(c.facing, f, &tiles.mesh->facing[group * kGroup]);
    tiles.mesh->known[group] = tiles.mesh->turn;
  }
  const VF *x = c.image.x, *y = c.image.y;
  c.outline = {hn::Min(hn::Min(x[0], x[1]), x[2]), hn::Max(hn::Max(x[0], x[1]), x[2]),
               hn::Min(hn::Min(y[0], y[1]), y[2]), hn::Max(hn::Max(y[0], y[1]), y[2])};
  c.drawn = hn::Eq(hn::Abs(c.facing), hn::Set(f, 1.0f));
  return c;
}

HWY_INLINE void find_nearness(const EyeProjection& e, Candidates& c) {
  for (std::size_t k = 0; k < 3; ++k)
    c.nearness[k] = e.orthographic ? dot_row(e.nearness, c.corners[k]) : c.image.over_w[k];
  c.nearest = hn::Max(hn::Max(c.nearness[0], c.nearness[1]), c.nearness[2]);
}

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

// From the nearest corner the normal's error counts the least.
HWY_INLINE VPoints nearest_of(const Candidates& c) {
  const auto is_first = hn::Eq(c.nearness[0], c.nearest), is_second = hn::Eq(c.nearness[1], c.nearest);
  const auto choose = [&](VF p, VF q, VF r)
                          HWY_ATTR { return hn::IfThenElse(is_first, p, hn::IfThenElse(is_second, q, r)); };
  const auto& [p, q, r] = c.corners;
  return {choose(p.x, q.x, r.x), choose(p.y, q.y, r.y), choose(p.z, q.z, r.z)};
}

// Nearness of the triangles' planes: at + x·across + y·down, less the doubt; of those seen too much edge on,
// which are not sound, nothing is said.
struct TrianglePlanes {
  VF at, across, down, doubt;
  VF distance;  // of the eye from the plane; in an orthographic view the sine under which it is seen
  VF sides;     // two together, at least as long as the triangle reaches
  hn::Mask<F> sound;
};

HWY_INLINE TrianglePlanes planes_of(const DepthTiles& tiles, const Candidates& c) {
  const F f;
  const PixelRays& rays = tiles.rays;
  const bool orthographic = tiles.projection.orthographic;
  TrianglePlanes out;
  const auto& [p, q, r] = c.corners;
  const VPoints pq = minus(q, p), pr = minus(r, p), normal = cross(pq, pr);
  const VF length = hn::Sqrt(dot(normal, normal));
  const VPoints unit{hn::Div(normal.x, length), hn::Div(normal.y, length), hn::Div(normal.z, length)};
  const VF reach = reach_of(c.corners);
  const VF plane_at = dot(unit, nearest_of(c));
  const VF scale = orthographic ? dot(unit, rays.forward) : plane_at;
  out.distance = hn::Abs(scale);
  const VF least = orthographic ? hn::Set(f, rays.edge_on)
                                : hn::Add(hn::Mul(hn::Set(f, static_cast<float>(kEdgeOnPart)), reach),
                                          hn::Set(f, static_cast<float>(kEdgeOnDistance)));
  out.sound = hn::And(hn::Eq(hn::Abs(c.facing), hn::Set(f, 1.0f)),
                      hn::And(hn::Gt(length, hn::Zero(f)), hn::Gt(hn::Abs(scale), least)));
  out.across = hn::Div(dot(unit, rays.across), scale), out.down = hn::Div(dot(unit, rays.down), scale);
  const VF ray_at = dot(unit, rays.at);
  out.at = hn::Div(orthographic ? hn::Sub(ray_at, plane_at) : ray_at, scale);
  // The normal is as uncertain as the corners are far and the triangle is thin.
  const VF sides = out.sides = hn::Add(largest(pq), largest(pr));
  out.doubt = hn::Div(hn::Mul(hn::Mul(hn::Set(f, kDrawnNormalRounding), reach), sides),
                      hn::Mul(length, hn::Abs(scale)));
  out.doubt = hn::Mul(out.doubt, orthographic ? hn::Add(sides, sides) : hn::Set(f, rays.stretch));
  return out;
}

// Triangle 16·group + i of the mesh in double precision.
HWY_NOINLINE inline ExactCorners exact_corners(const EyeProjection& e, const OccluderTopology& mesh,
                                               std::size_t group, std::size_t i) {
  ExactCorners out;
  for (std::size_t k = 0; k < 3; ++k) {
    const float* from = &mesh.corners[(group * 9 + 3 * k) * kGroup + i];
    out[k] = about_eye(e, Vec3{from[0], from[kGroup], from[2 * kGroup]});
  }
  return out;
}

// Of those of a group that the near plane cuts, which count where a pixel's margin does.
HWY_NOINLINE void know_cut(DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group) {
  float* facing = &tiles.mesh->facing[group * kGroup];
  for (std::size_t i = 0; i < kGroup; ++i) {
    if (std::fabs(facing[i]) != kCut) continue;
    const CutTriangle its = cut_triangle(tiles, exact_corners(tiles.projection, mesh, group, i));
    tiles.mesh->slant[group * kGroup + i] = its.slant;
    if (!its.counts) facing[i] = 0;
  }
}

// Found when first asked for. Where a pixel's margin counts, those seen edge on are as if they were not
// there: the mesh ends at them.
void know_facing(DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group) {
  const F f;
  MeshScratch& s = *tiles.mesh;
  if (s.known[group] == s.turn) return;
  s.known[group] = s.turn;
  std::uint32_t cut = 0;
  for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(f)) {
    Candidates c = candidates_of(tiles, mesh, group, lane);
    if (tiles.margin > 0) {
      find_nearness(tiles.projection, c);
      const TrianglePlanes planes = planes_of(tiles, c);
      const auto is_cut = hn::Eq(hn::Abs(c.facing), hn::Set(f, kCut));
      cut |= bits_of(f, is_cut);
      c.facing = hn::IfThenElseZero(hn::Or(planes.sound, is_cut), c.facing);
      const VF slant = hn::Add(hn::Abs(planes.across), hn::Abs(planes.down));
      hn::Store(hn::IfThenElseZero(planes.sound, slant), f, &s.slant[group * kGroup + lane]);
    }
    hn::Store(c.facing, f, &s.facing[group * kGroup + lane]);
  }
  if (cut != 0) know_cut(tiles, mesh, group);
}

HWY_INLINE void set_planes(const DepthTiles& tiles, const OccluderTopology& mesh, Candidates& c,
                           ReadyTriangles& out) {
  const F f;
  const auto [at, across, down, doubt, distance, sides, sound] = planes_of(tiles, c);
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

// The groups whose facings tell where the mesh goes on: at the group's shared edges, or within a margin of
// it.
inline std::span<const std::uint32_t> around_group(const DepthTiles& tiles, const OccluderTopology& mesh,
                                                   std::size_t group) {
  const OccluderTopology::Group& its = mesh.groups[group];
  if (tiles.margin > 0) return std::span(mesh.rings).subspan(its.first_ring, its.end_ring - its.first_ring);
  return std::span(mesh.beside).subspan(its.first_beside, its.end_beside - its.first_beside);
}

// A vector of a group's triangles, some of which are drawn if `some`.
HWY_INLINE void set_up(const DepthTiles& tiles, const OccluderTopology& mesh, Candidates& c,
                       const std::array<std::uint32_t, 3>& shared, bool some, ReadyTriangles& out) {
  const F f;
  if (some) {
    if (hn::AllFalse(f, c.drawn)) find_nearness(tiles.projection, c);
    set_planes(tiles, mesh, c, out);
  }
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
  const std::size_t lanes = hn::Lanes(f);
  std::array<Candidates, kGroup / hn::MaxLanes(F())> vectors;
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
  if (tiles.margin > 0 || its.first_shared < its.end_shared) know_facing(tiles, mesh, group);
  for (const std::uint32_t other : around_group(tiles, mesh, group)) know_facing(tiles, mesh, other);
  const std::array<std::uint32_t, 3> shared = shared_seams(tiles, mesh, group);
  for (std::size_t v = 0; v * lanes < kGroup; ++v) set_up(tiles, mesh, vectors[v], shared, some, out);
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
