// Which way a mesh's triangles turn on the image, and their planes, for every SIMD width. Included by files
// that foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_MESH_FACING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_MESH_FACING_INL
#undef SIGHTLINE_OCCLUSION_MESH_FACING_INL
#else
#define SIGHTLINE_OCCLUSION_MESH_FACING_INL
#endif

#include <bit>
#include <cmath>
#include <span>
#include <utility>

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

SIGHTLINE_INLINE_IN_BOTH Candidates candidates_of(DepthTiles& tiles, const OccluderTopology& mesh,
                                                  std::size_t group, std::size_t lane) {
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
  const auto whole = hn::Eq(hn::Abs(c.facing), hn::Set(f, 1.0f));
  if (hn::AllFalse(f, whole)) {
    const VF zero = hn::Zero(f);
    return {zero, zero, zero, zero, zero, zero, whole};
  }
  const PixelRays& rays = tiles.rays;
  const bool orthographic = tiles.projection.orthographic;
  TrianglePlanes out;
  const auto& [p, q, r] = c.corners;
  const VPoints pq = minus(q, p), pr = minus(r, p), normal = cross(pq, pr);
  const VF length = hn::Sqrt(dot(normal, normal));
  const VPoints unit{hn::Div(normal.x, length), hn::Div(normal.y, length), hn::Div(normal.z, length)};
  const VF reach = reach_of(c.corners);
  const VPoints nearest = nearest_of(c);
  const VF plane_at = dot(unit, nearest);
  const VF scale = orthographic ? dot(unit, rays.forward) : plane_at;
  out.distance = hn::Abs(scale);
  const VF least = orthographic ? hn::Set(f, rays.edge_on)
                                : hn::Add(hn::Mul(hn::Set(f, static_cast<float>(kEdgeOnPart)), reach),
                                          hn::Set(f, static_cast<float>(kEdgeOnDistance)));
  out.sound = hn::And(whole, hn::And(hn::Gt(length, hn::Zero(f)), hn::Gt(hn::Abs(scale), least)));
  out.across = hn::Div(dot(unit, rays.across), scale), out.down = hn::Div(dot(unit, rays.down), scale);
  const VF ray_at = dot(unit, rays.at);
  out.at = hn::Div(orthographic ? hn::Sub(ray_at, plane_at) : ray_at, scale);
  // The normal is as uncertain as the corners are far and the triangle is thin.
  const VF sides = out.sides = hn::Add(largest(pq), largest(pr));
  out.doubt = hn::Div(hn::Mul(hn::Mul(hn::Set(f, kDrawnNormalRounding), reach), sides),
                      hn::Mul(length, hn::Abs(scale)));
  // It turns rays, and moves the corner, which may lie many times as far to the side as it is deep.
  const VF stretch = hn::Set(f, rays.stretch), aside = hn::Mul(c.nearest, hn::Sqrt(dot(nearest, nearest)));
  const VF far = hn::IfThenElse(hn::Gt(aside, hn::Mul(hn::Set(f, kAside), stretch)), aside, stretch);
  out.doubt = hn::Mul(out.doubt, orthographic ? hn::Add(sides, sides) : far);
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

// Of those of a group that the near plane cuts, a bit each, which count where a pixel's margin does.
HWY_NOINLINE void know_cut(DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group,
                           std::uint32_t cut) {
  float* facing = &tiles.mesh->facing[group * kGroup];
  for (; cut != 0; cut &= cut - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(cut));
    const CutTriangle its = cut_triangle(tiles, exact_corners(tiles.projection, mesh, group, i));
    tiles.mesh->slant[group * kGroup + i] = its.counts ? -its.slant : its.slant;
    if (!its.counts) facing[i] = 0;
  }
}

// Where a pixel's margin counts, what the others of a mesh ask of a vector of triangles. Those seen edge on
// are as if they were not there: the mesh ends at them. Returns those of which know_cut() has more to say, a
// bit each: what lies out of view counts, since no pixel reaches it.
SIGHTLINE_INLINE_IN_BOTH std::uint32_t store_facing(DepthTiles& tiles, const Candidates& c,
                                                    const TrianglePlanes& planes) {
  const F f;
  MeshScratch& s = *tiles.mesh;
  const std::size_t first = c.group * kGroup + c.lane;
  VF facing = hn::IfThenElseZero(planes.sound, c.facing);
  const VF slant = hn::Add(hn::Abs(planes.across), hn::Abs(planes.down));
  std::uint32_t cut = bits_of(f, hn::Eq(hn::Abs(c.facing), hn::Set(f, kCut)));
  if (cut != 0) {
    const std::uint32_t beyond =
        beyond_a_side(tiles, c.corners, row_errors(tiles.projection, reach_of(c.corners)));
    const VF counts = hn::Mul(c.facing, hn::Set(f, 1 / kCut));
    facing = hn::IfThenElse(mask_of(f, cut), hn::IfThenElse(mask_of(f, beyond), counts, c.facing), facing);
    cut &= ~beyond;
  }
  hn::Store(facing, f, &s.facing[first]);
  hn::Store(hn::IfThenElseZero(planes.sound, slant), f, &s.slant[first]);
  return cut << c.lane;
}

// Of a group that is set up, from what is known of it.
HWY_INLINE void know_facing(DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group,
                            std::span<const Candidates> vectors, std::span<const TrianglePlanes> planes) {
  MeshScratch& s = *tiles.mesh;
  if (std::exchange(s.known[group], s.turn) == s.turn) return;
  std::uint32_t cut = 0;
  for (std::size_t v = 0; v < vectors.size(); ++v) cut |= store_facing(tiles, vectors[v], planes[v]);
  if (cut != 0) know_cut(tiles, mesh, group, cut);
}

// Found when first asked for.
void know_facing(DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group) {
  const F f;
  MeshScratch& s = *tiles.mesh;
  if (std::exchange(s.known[group], s.turn) == s.turn) return;
  std::uint32_t cut = 0;
  for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(f)) {
    Candidates c = candidates_of(tiles, mesh, group, lane);
    if (tiles.margin > 0) {
      find_nearness(tiles.projection, c);
      cut |= store_facing(tiles, c, planes_of(tiles, c));
    } else {
      hn::Store(c.facing, f, &s.facing[group * kGroup + lane]);
    }
  }
  if (cut != 0) know_cut(tiles, mesh, group, cut);
}

// Asks for what know_facing() reads of a group.
HWY_INLINE void prefetch_corners(const OccluderTopology& mesh, std::size_t group) {
  hwy::Prefetch(&mesh.groups[group].one_sided);
  for (std::size_t i = 0; i < 9; ++i) hwy::Prefetch(&mesh.corners[(group * 9 + i) * kGroup]);
}

// The groups whose facings tell where the mesh goes on: at the group's shared edges, or within a margin of
// it.
inline std::span<const std::uint32_t> around_group(const DepthTiles& tiles, const OccluderTopology& mesh,
                                                   std::size_t group) {
  const OccluderTopology::Group& its = mesh.groups[group];
  if (tiles.margin > 0) return std::span(mesh.rings).subspan(its.first_ring, its.end_ring - its.first_ring);
  return std::span(mesh.beside).subspan(its.first_beside, its.end_beside - its.first_beside);
}

// Finds which way triangles turn that a group's own ask for. Memory is asked for all of them before the first
// is read.
HWY_INLINE void know_around(DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group) {
  const std::span<const std::uint32_t> others = around_group(tiles, mesh, group);
  for (const std::uint32_t other : others) {
    if (tiles.mesh->known[other] != tiles.mesh->turn) prefetch_corners(mesh, other);
  }
  for (const std::uint32_t other : others) know_facing(tiles, mesh, other);
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
