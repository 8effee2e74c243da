// Triangles of meshes into the tiles, set up a vector at a time; and single polygons.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "library/geometry/radix_sort.hpp"
#include "library/geometry/view_depth.hpp"
#include "library/occlusion/depth_tiles.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/occlusion/mesh_raster.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "library/occlusion/depth_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

using I = hn::RebindToSigned<F>;
using VI = hn::Vec<I>;

void draw_one(DepthTiles& tiles, const Convex& polygon) {
  draw_polygon(tiles, polygon, tiles_of(tiles, polygon.left, polygon.right, polygon.top, polygon.bottom));
}

struct V3 {
  VF x, y, z;
};

HWY_INLINE VF dot(const V3& a, const V3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE VF dot(const V3& a, const std::array<float, 3>& b) {
  const F f;
  return dot(a, V3{hn::Set(f, b[0]), hn::Set(f, b[1]), hn::Set(f, b[2])});
}
HWY_INLINE V3 minus(const V3& a, const V3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V3 cross(const V3& a, const V3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

// A vector of triangles' corners about the eye, from triangle 16·group + lane on.
HWY_INLINE std::array<V3, 3> corners_about_eye(const EyeProjection& e, const OccluderTopology& mesh,
                                               const Affine& transform, std::size_t group, std::size_t lane) {
  const F f;
  std::array<V3, 3> out;
  for (std::size_t k = 0; k < 3; ++k) {
    const float* from = &mesh.corners[(group * 9 + 3 * k) * OccluderTopology::kGroup + lane];
    const V3 p{hn::Load(f, from), hn::Load(f, from + OccluderTopology::kGroup),
               hn::Load(f, from + 2 * OccluderTopology::kGroup)};
    const auto about_eye = [&](const Vec4& row, float high, float low) HWY_ATTR {
      return hn::Sub(hn::Sub(dot_row(row, p.x, p.y, p.z), hn::Set(f, high)), hn::Set(f, low));
    };
    out[k] = {about_eye(transform.rows[0], e.eye_high.x, e.eye_low.x),
              about_eye(transform.rows[1], e.eye_high.y, e.eye_low.y),
              about_eye(transform.rows[2], e.eye_high.z, e.eye_low.z)};
  }
  return out;
}

// Corners on the image. Equal corners of different triangles give equal bits.
struct OnImage {
  VF x[3], y[3], over_w[3];
};

HWY_INLINE OnImage on_image(const EyeProjection& e, const std::array<V3, 3>& corners) {
  const F f;
  OnImage out;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto dot = [&](const Vec4& row)
                         HWY_ATTR { return dot_row(row, corners[k].x, corners[k].y, corners[k].z); };
    out.over_w[k] = hn::Div(hn::Set(f, 1.0f), dot(e.w));
    out.x[k] = hn::Mul(dot(e.x), out.over_w[k]), out.y[k] = hn::Mul(dot(e.y), out.over_w[k]);
  }
  return out;
}

// Which way a triangle turns on the image: 1 or -1; 0: too small; kCut: the near plane cuts it.
constexpr float kCut = 2;

HWY_INLINE VF facing_of(const DepthTiles& tiles, const std::array<V3, 3>& corners, const OnImage& image) {
  const F f;
  const auto clearance = [&](std::size_t k) HWY_ATTR {
    return dot_row(tiles.rays.near_plane, corners[k].x, corners[k].y, corners[k].z);
  };
  const VF ax = image.x[0], ay = image.y[0];
  const VF area = hn::Sub(hn::Mul(hn::Sub(image.x[1], ax), hn::Sub(image.y[2], ay)),
                          hn::Mul(hn::Sub(image.x[2], ax), hn::Sub(image.y[1], ay)));
  const VF zero = hn::Zero(f), one = hn::Set(f, 1.0f), least = hn::Set(f, 0.02f);
  const VF facing = hn::IfThenElse(hn::Gt(area, least), one,
                                   hn::IfThenElse(hn::Lt(area, hn::Neg(least)), hn::Neg(one), zero));
  // Not a number counts as behind, too.
  const auto before = [&](std::size_t k) HWY_ATTR { return hn::Ge(clearance(k), zero); };
  const auto a = before(0), b = before(1), c = before(2);
  return hn::IfThenElse(hn::And(hn::And(a, b), c), facing,
                        hn::IfThenElseZero(hn::Or(hn::Or(a, b), c), hn::Set(f, kCut)));
}

// Found when first asked for.
void know_facing(DepthTiles& tiles, const OccluderTopology& mesh, const Affine& transform,
                 std::size_t group) {
  const F f;
  MeshScratch& s = tiles.mesh;
  if (s.known[group] == s.turn) return;
  s.known[group] = s.turn;
  for (std::size_t lane = 0; lane < OccluderTopology::kGroup; lane += hn::Lanes(f)) {
    const auto corners = corners_about_eye(tiles.projection, mesh, transform, group, lane);
    hn::Store(facing_of(tiles, corners, on_image(tiles.projection, corners)), f,
              &s.facing[group * OccluderTopology::kGroup + lane]);
  }
}

// A group of triangles, ready to be drawn.
struct Triangles {
  alignas(64) std::array<float, 16> left, right, top, bottom, nearest, at, across, down;
  alignas(64) std::array<std::array<float, 16>, 3> slope, edge_at;
  std::array<std::uint32_t, 3> on_right{}, steep{};  // a bit a triangle: the edge bounds it to the right
  std::uint32_t drawn = 0, cut = 0;
  // Have a plane and turn one way; to the right; have an outer edge that is flat on the image.
  std::uint32_t sound = 0, to_right = 0, flat = 0;
};

// Those that lie wholly to one side of what is in view.
HWY_INLINE std::uint32_t beyond_a_side(const DepthTiles& tiles, const std::array<V3, 3>& corners) {
  const F f;
  const EyeProjection& e = tiles.projection;
  const VF width = hn::Set(f, static_cast<float>(tiles.width)),
           height = hn::Set(f, static_cast<float>(tiles.height)), zero = hn::Zero(f);
  auto left = hn::FirstN(f, hn::Lanes(f)), right = left, above = left, below = left;
  for (const V3& c : corners) {
    const VF x = dot_row(e.x, c.x, c.y, c.z), y = dot_row(e.y, c.x, c.y, c.z),
             w = dot_row(e.w, c.x, c.y, c.z);
    left = hn::And(left, hn::Lt(x, zero)), right = hn::And(right, hn::Gt(x, hn::Mul(width, w)));
    above = hn::And(above, hn::Lt(y, zero)), below = hn::And(below, hn::Gt(y, hn::Mul(height, w)));
  }
  return bits_of(hn::Or(hn::Or(left, right), hn::Or(above, below)));
}

HWY_INLINE V3 nearest_of(const std::array<V3, 3>& corners, VF first, VF second, VF nearest) {
  const auto is_first = hn::Eq(first, nearest), is_second = hn::Eq(second, nearest);
  const auto choose = [&](VF a, VF b, VF c)
                          HWY_ATTR { return hn::IfThenElse(is_first, a, hn::IfThenElse(is_second, b, c)); };
  return {choose(corners[0].x, corners[1].x, corners[2].x), choose(corners[0].y, corners[1].y, corners[2].y),
          choose(corners[0].z, corners[1].z, corners[2].z)};
}

// Triangle 16·group + i of the mesh in double precision.
std::array<std::array<double, 3>, 3> about_eye(const EyeProjection& e, const OccluderTopology& mesh,
                                               const Affine& transform, std::size_t group, std::size_t i) {
  std::array<std::array<double, 3>, 3> out;
  for (std::size_t k = 0; k < 3; ++k) {
    const float* from = &mesh.corners[(group * 9 + 3 * k) * OccluderTopology::kGroup + i];
    const Vec3 at = transform_point(
        transform, {from[0], from[OccluderTopology::kGroup], from[2 * OccluderTopology::kGroup]});
    out[k] = {double{at.x} - e.eye_high.x - e.eye_low.x, double{at.y} - e.eye_high.y - e.eye_low.y,
              double{at.z} - e.eye_high.z - e.eye_low.z};
  }
  return out;
}

// Triangles 16·group + lane … of the mesh.
HWY_INLINE void set_up(DepthTiles& tiles, const OccluderTopology& mesh, const Affine& transform,
                       std::size_t group, std::size_t lane, Triangles& out) {
  const F f;
  const I i32;
  const EyeProjection& e = tiles.projection;
  const auto corners = corners_about_eye(e, mesh, transform, group, lane);
  const OnImage image = on_image(e, corners);
  const VF facing = facing_of(tiles, corners, image);
  if (hn::Lanes(f) == OccluderTopology::kGroup) {
    hn::Store(facing, f, &tiles.mesh.facing[group * OccluderTopology::kGroup]);
    tiles.mesh.known[group] = tiles.mesh.turn;
  }
  const VF zero = hn::Zero(f), one = hn::Set(f, 1.0f);
  const std::uint32_t cut = bits_of(hn::Eq(facing, hn::Set(f, kCut)));
  if (cut != 0) out.cut |= (cut & ~beyond_a_side(tiles, corners)) << lane;
  auto drawn = hn::Eq(hn::Abs(facing), one);
  const VF *x = image.x, *y = image.y;
  const VF left = hn::Min(hn::Min(x[0], x[1]), x[2]), right = hn::Max(hn::Max(x[0], x[1]), x[2]);
  VF top = hn::Min(hn::Min(y[0], y[1]), y[2]), bottom = hn::Max(hn::Max(y[0], y[1]), y[2]);
  // Nothing where no pixel centre lies between the sides, nor beyond the image.
  const VF half = hn::Set(f, 0.5f);
  const auto first = [&](VF low) HWY_ATTR { return hn::Max(hn::Ceil(hn::Sub(low, half)), zero); };
  const auto last = [&](VF high, std::uint32_t size) HWY_ATTR {
    return hn::Min(hn::Floor(hn::Sub(high, half)), hn::Set(f, static_cast<float>(size) - 1));
  };
  const VF x0 = first(left), x1 = last(right, tiles.width), y0 = first(top), y1 = last(bottom, tiles.height);
  drawn = hn::And(drawn, hn::And(hn::Le(x0, x1), hn::Le(y0, y1)));
  if (hn::AllFalse(f, drawn)) return;

  // Nor behind the tiles of the corners, where those are all.
  const auto nearness = [&](std::size_t k) HWY_ATTR {
    const V3& c = corners[k];
    return e.orthographic ? dot_row(e.nearness, c.x, c.y, c.z) : image.over_w[k];
  };
  const VF nearest = hn::Max(hn::Max(nearness(0), nearness(1)), nearness(2));
  const auto tile = [&](VF at) HWY_ATTR {
    return hn::ShiftRight<3>(hn::ConvertTo(i32, hn::IfThenElseZero(drawn, at)));
  };
  const VI tx0 = tile(x0), tx1 = tile(x1), ty0 = tile(y0), ty1 = tile(y1), next = hn::Set(i32, 1),
           stride = hn::Set(i32, static_cast<std::int32_t>(tiles.stride));
  const auto many = hn::Or(hn::Gt(hn::Sub(tx1, tx0), next), hn::Gt(hn::Sub(ty1, ty0), next));
  const auto farthest = [&](VI ty, VI tx) HWY_ATTR {
    return hn::GatherIndex(f, tiles.farthest.data(), hn::Add(hn::Mul(ty, stride), tx));
  };
  const VF least_of_all = hn::Min(hn::Min(farthest(ty0, tx0), farthest(ty0, tx1)),
                                  hn::Min(farthest(ty1, tx0), farthest(ty1, tx1)));
  drawn = hn::And(drawn, hn::Or(hn::RebindMask(f, many), hn::Lt(least_of_all, nearest)));
  if (hn::AllFalse(f, drawn)) return;

  const V3 &p = corners[0], &q = corners[1], &r = corners[2];
  const V3 normal = cross(minus(q, p), minus(r, p));
  const VF length = hn::Sqrt(dot(normal, normal));
  const V3 unit{hn::Div(normal.x, length), hn::Div(normal.y, length), hn::Div(normal.z, length)};
  const auto most = [&](const V3& v)
                        HWY_ATTR { return hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z)); };
  const VF reach = hn::Max(hn::Max(most(p), most(q)), most(r));
  const PixelRays& rays = tiles.rays;
  const bool orthographic = e.orthographic;
  // From the nearest corner, where the normal's error counts the least.
  const V3 anchor = nearest_of(corners, nearness(0), nearness(1), nearest);
  const VF plane_at = dot(unit, anchor);
  const VF scale = orthographic ? dot(unit, rays.forward) : plane_at;
  // Seen too much edge on, the plane says nothing.
  const VF least =
      orthographic ? hn::Set(f, 1e-4f) : hn::Add(hn::Mul(hn::Set(f, 1e-5f), reach), hn::Set(f, 1e-6f));
  const auto sound =
      hn::And(hn::Eq(hn::Abs(facing), one), hn::And(hn::Gt(length, zero), hn::Gt(hn::Abs(scale), least)));
  drawn = hn::And(drawn, sound);
  const VF across = hn::Div(dot(unit, rays.across), scale), down = hn::Div(dot(unit, rays.down), scale);
  const VF ray_at = dot(unit, rays.at);
  const VF start = hn::Div(orthographic ? hn::Sub(ray_at, plane_at) : ray_at, scale);
  // The normal is as uncertain as the corners are far and the triangle is thin.
  const VF sides = hn::Add(most(minus(q, p)), most(minus(r, p)));
  VF doubt = hn::Div(hn::Mul(hn::Mul(hn::Set(f, 4.2e-7f), reach), sides), hn::Mul(length, hn::Abs(scale)));
  if (orthographic) doubt = hn::Mul(doubt, hn::Add(sides, sides));
  hn::Store(hn::Sub(moved_back(start, across, down, nearest), doubt), f, &out.at[lane]);
  hn::Store(across, f, &out.across[lane]);
  hn::Store(down, f, &out.down[lane]);
  hn::Store(nearest, f, &out.nearest[lane]);

  const VF farthest_out =
      hn::Max(hn::Max(hn::Abs(left), hn::Abs(right)), hn::Max(hn::Abs(top), hn::Abs(bottom)));
  const VF inset = hn::Add(hn::Set(f, kInset), hn::Mul(hn::Set(f, kInsetGrowth), farthest_out));
  const auto to_right = hn::Gt(facing, zero);
  out.sound |= bits_of(sound) << lane, out.to_right |= bits_of(to_right) << lane;
  const auto from_middle = [&](VF at_x, VF at_y) HWY_ATTR {
    return hn::Add(hn::Abs(hn::Sub(at_x, hn::Set(f, 0.5f * static_cast<float>(tiles.width)))),
                   hn::Abs(hn::Sub(at_y, hn::Set(f, 0.5f * static_cast<float>(tiles.height)))));
  };
  const OccluderTopology::Group& its = mesh.groups[group];
  know_facing(tiles, mesh, transform, group);
  for (std::uint32_t i = its.first_beside; i < its.end_beside; ++i)
    know_facing(tiles, mesh, transform, mesh.beside[i]);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const VI other = hn::Load(i32, &mesh.neighbour[(group * 3 + k) * OccluderTopology::kGroup + lane]);
    const auto has_other = hn::Gt(other, hn::Set(i32, -1));
    const VF others = hn::GatherIndex(f, tiles.mesh.facing.data(), hn::Max(other, hn::Zero(i32)));
    const auto seam = hn::And(hn::RebindMask(f, has_other), hn::Eq(others, facing));
    const VF by_seam = hn::IfThenZeroElse(seam, inset);
    const auto falls = hn::Gt(y[next], y[k]);
    const auto on_right = hn::Not(hn::Xor(falls, to_right));
    // From the vertex nearer the image's middle, where rounding is least; of two as near, from that of lower
    // number: both sides of a seam compute the same bits.
    const VF here = from_middle(x[k], y[k]), there = from_middle(x[next], y[next]);
    const auto turned =
        hn::Or(hn::Lt(there, here), hn::And(hn::Eq(there, here), pixels_at(its.turned[k], lane)));
    const VF ax = hn::IfThenElse(turned, x[next], x[k]), ay = hn::IfThenElse(turned, y[next], y[k]),
             bx = hn::IfThenElse(turned, x[k], x[next]), by = hn::IfThenElse(turned, y[k], y[next]);
    const VF rise = hn::Sub(by, ay), slope = hn::Div(hn::Sub(bx, ax), rise),
             edge_at = hn::Sub(ax, hn::Mul(ay, slope));
    const VF inwards = hn::Mul(by_seam, hn::Add(one, hn::Abs(slope)));
    const auto steep = hn::Ge(hn::Abs(rise), hn::Set(f, kFlat));
    out.steep[k] |= bits_of(steep) << lane;
    out.on_right[k] |= bits_of(on_right) << lane;
    hn::Store(slope, f, &out.slope[k][lane]);
    hn::Store(hn::IfThenElse(on_right, hn::Sub(edge_at, inwards), hn::Add(edge_at, inwards)), f,
              &out.edge_at[k][lane]);
    // A flat edge that is no seam bounds the rows.
    const auto bounds = hn::AndNot(seam, hn::Not(steep));
    out.flat |= bits_of(bounds) << lane;
    const auto above = hn::Gt(y[(k + 2) % 3], ay);
    top = hn::IfThenElse(hn::And(bounds, above), hn::Max(top, hn::Add(hn::Max(ay, by), inset)), top);
    bottom =
        hn::IfThenElse(hn::AndNot(above, bounds), hn::Min(bottom, hn::Sub(hn::Min(ay, by), inset)), bottom);
  }
  // Where only seams bound a corner of the outline, rounding may carry them beyond it.
  hn::Store(hn::Add(left, inset), f, &out.left[lane]);
  hn::Store(hn::Sub(right, inset), f, &out.right[lane]);
  hn::Store(hn::Add(top, inset), f, &out.top[lane]);
  hn::Store(hn::Sub(bottom, inset), f, &out.bottom[lane]);
  out.drawn |= bits_of(drawn) << lane;
}

// The groups that the image may hold, near ones first. A group left out by mistake would only hide less.
void find_groups(DepthTiles& tiles, const OccluderTopology& mesh, const Affine& transform) {
  const F f;
  const EyeProjection& e = tiles.projection;
  const auto width = static_cast<float>(tiles.width), height = static_cast<float>(tiles.height);
  const auto minus = [](float scale, const Vec4& a, const Vec4& b) {
    return Vec4{scale * a.x - b.x, scale * a.y - b.y, scale * a.z - b.z, scale * a.w - b.w};
  };
  const Vec4 sides[5] = {e.x, minus(width, e.w, e.x), e.y, minus(height, e.w, e.y), tiles.rays.near_plane};
  const Vec4 depth = e.orthographic ? Vec4{-e.nearness.x, -e.nearness.y, -e.nearness.z, 0} : e.w;
  MeshScratch& s = tiles.mesh;
  s.group.clear(), s.near_first.clear();
  for (std::size_t first = 0; first < mesh.groups.size(); first += hn::Lanes(f)) {
    const float* box = &mesh.box[first / 16 * 96 + first % 16];
    const V3 c{hn::Load(f, box), hn::Load(f, box + 16), hn::Load(f, box + 32)},
        h{hn::Load(f, box + 48), hn::Load(f, box + 64), hn::Load(f, box + 80)};
    // Of the box around the moved box.
    const auto size = [&](const Vec4& row, const V3& half) HWY_ATTR {
      return dot(half, std::array<float, 3>{std::fabs(row.x), std::fabs(row.y), std::fabs(row.z)});
    };
    const auto& rows = transform.rows;
    const V3 middle{dot_row(rows[0], c.x, c.y, c.z), dot_row(rows[1], c.x, c.y, c.z),
                    dot_row(rows[2], c.x, c.y, c.z)};
    const V3 half{size(rows[0], h), size(rows[1], h), size(rows[2], h)};
    const auto about_eye = [&](VF v, float high, float low)
                               HWY_ATTR { return hn::Sub(hn::Sub(v, hn::Set(f, high)), hn::Set(f, low)); };
    const V3 q{about_eye(middle.x, e.eye_high.x, e.eye_low.x), about_eye(middle.y, e.eye_high.y, e.eye_low.y),
               about_eye(middle.z, e.eye_high.z, e.eye_low.z)};
    auto in = hn::FirstN(f, mesh.groups.size() - first);
    for (const Vec4& side : sides)
      in = hn::And(in, hn::Ge(hn::Add(dot_row(side, q.x, q.y, q.z), size(side, half)), hn::Zero(f)));
    const VF nearest = hn::Sub(dot_row(depth, q.x, q.y, q.z), size(depth, half));
    std::uint32_t rest = bits_of(in);
    if (rest == 0) continue;
    alignas(64) std::array<std::array<float, 16>, 7> out;
    hn::Store(hn::Sub(middle.x, half.x), f, out[0].data());
    hn::Store(hn::Sub(middle.y, half.y), f, out[1].data());
    hn::Store(hn::Sub(middle.z, half.z), f, out[2].data());
    hn::Store(hn::Add(middle.x, half.x), f, out[3].data());
    hn::Store(hn::Add(middle.y, half.y), f, out[4].data());
    hn::Store(hn::Add(middle.z, half.z), f, out[5].data());
    hn::Store(nearest, f, out[6].data());
    for (; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const std::size_t place = s.group.size();
      s.near_first.push_back(std::uint64_t{geometry::sortable(out[6][i])} << 32 | place);
      for (std::size_t side = 0; side < 6; ++side) s.box[side][place] = out[side][i];
      s.group.push_back(static_cast<std::uint32_t>(first + i));
    }
  }
  // By the upper half of the depths, near enough for an order that only saves time.
  geometry::sort_by_high_bits(s.near_first, s.other, 48);
}

// Adds the first `count` edges of triangle i.
HWY_INLINE void add_edges(const Triangles& ready, int i, std::size_t count, Convex& out) {
  for (std::size_t k = 0; k < count; ++k) {
    // Written to both lists and counted in one: no branch to guess.
    const std::size_t l = out.left_edges, r = out.right_edges;
    out.left_at[l] = out.right_at[r] = ready.edge_at[k][i];
    out.left_slope[l] = out.right_slope[r] = ready.slope[k][i];
    const std::uint32_t steep = ready.steep[k] >> i & 1, on_right = ready.on_right[k] >> i & 1;
    out.right_edges += steep & on_right;
    out.left_edges += steep & ~on_right & 1;
  }
}

HWY_INLINE void draw_one_of(DepthTiles& tiles, const Triangles& ready, int i) {
  const TileRange range = tiles_of(tiles, ready.left[i], ready.right[i], ready.top[i], ready.bottom[i]);
  if (hidden_tiles(tiles, range, ready.nearest[i])) return;
  Convex out;
  out.left = ready.left[i], out.right = ready.right[i];
  out.top = ready.top[i], out.bottom = ready.bottom[i];
  out.at = ready.at[i], out.across = ready.across[i], out.down = ready.down[i];
  add_edges(ready, i, 3, out);
  draw_polygon(tiles, out, range);
}

// How far apart a quad's halves may lie, of their nearness, before they are drawn one by one.
constexpr float kMostApart = 4e-5f;

// Triangles i and i + 1 as one quad on the first one's plane, moved behind the second's wherever the image
// may hold the quad; false where their planes differ by more than rounding. Whether the answer is true does
// not depend on what is drawn already, for widths of vectors see that at different times.
HWY_INLINE bool draw_quad(DepthTiles& tiles, const Triangles& ready, int i) {
  Convex out;
  out.left = std::min(ready.left[i], ready.left[i + 1]);
  out.right = std::max(ready.right[i], ready.right[i + 1]);
  out.top = std::min(ready.top[i], ready.top[i + 1]);
  out.bottom = std::max(ready.bottom[i], ready.bottom[i + 1]);
  out.across = ready.across[i], out.down = ready.down[i];
  const float nearest = std::max(ready.nearest[i], ready.nearest[i + 1]);
  const float across = out.across - ready.across[i + 1], down = out.down - ready.down[i + 1];
  const float x0 = std::max(out.left, 0.0f), x1 = std::min(out.right, static_cast<float>(tiles.width)),
              y0 = std::max(out.top, 0.0f), y1 = std::min(out.bottom, static_cast<float>(tiles.height));
  const float apart = ready.at[i] - ready.at[i + 1];
  const float before = apart + std::max(across * x0, across * x1) + std::max(down * y0, down * y1),
              behind = -apart - std::min(across * x0, across * x1) - std::min(down * y0, down * y1);
  const float rounding =
      5e-7f * (std::fabs(ready.at[i]) + std::fabs(out.across) * x1 + std::fabs(out.down) * y1);
  const float back = std::max(before, 0.0f) + rounding;
  const float most = kMostApart * std::min(std::fabs(ready.nearest[i]), std::fabs(ready.nearest[i + 1]));
  if (!(back + std::max(behind, 0.0f) <= most)) return false;
  out.at = ready.at[i] - back;
  const TileRange range = tiles_of(tiles, out.left, out.right, out.top, out.bottom);
  if (hidden_tiles(tiles, range, nearest)) return true;
  add_edges(ready, i, 2, out);
  add_edges(ready, i + 1, 2, out);
  draw_polygon(tiles, out, range);
  return true;
}

HWY_INLINE void draw_group(DepthTiles& tiles, const OccluderTopology& mesh, const Affine& transform,
                           std::size_t group) {
  Triangles ready;
  for (std::size_t lane = 0; lane < OccluderTopology::kGroup; lane += hn::Lanes(F()))
    set_up(tiles, mesh, transform, group, lane, ready);
  const std::uint32_t alike = ready.sound & ready.sound >> 1 & ~(ready.to_right ^ ready.to_right >> 1) &
                              ~(ready.flat | ready.flat >> 1);
  std::uint32_t rest = ready.drawn;
  for (std::uint32_t halves = mesh.groups[group].first_half & alike & (rest | rest >> 1); halves != 0;
       halves &= halves - 1) {
    const int i = std::countr_zero(halves);
    if (draw_quad(tiles, ready, i)) rest &= ~(3u << i);
  }
  for (; rest != 0; rest &= rest - 1) draw_one_of(tiles, ready, std::countr_zero(rest));
  for (rest = ready.cut; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    draw_clipped_triangle(tiles, about_eye(tiles.projection, mesh, transform, group, i));
  }
}

HWY_INLINE void prefetch_group(const OccluderTopology& mesh, std::size_t group) {
  constexpr std::size_t kGroup = OccluderTopology::kGroup;
  hwy::Prefetch(&mesh.groups[group]);
  for (std::size_t i = 0; i < 9; ++i) hwy::Prefetch(&mesh.corners[(group * 9 + i) * kGroup]);
  for (std::size_t i = 0; i < 3; ++i) hwy::Prefetch(&mesh.neighbour[(group * 3 + i) * kGroup]);
}

void draw_triangles(DepthTiles& tiles, const OccluderTopology& mesh, const Affine& transform) {
  find_groups(tiles, mesh, transform);
  const MeshScratch& s = tiles.mesh;
  constexpr std::size_t kSome = 16;
  for (std::size_t first = 0; first < s.near_first.size(); first += kSome) {
    const std::size_t count = std::min(kSome, s.near_first.size() - first);
    const auto place = [&](std::size_t i) { return static_cast<std::uint32_t>(s.near_first[first + i]); };
    std::array<std::array<float, kSome>, 6> box;
    for (std::size_t side = 0; side < 6; ++side) {
      for (std::size_t i = 0; i < count; ++i) box[side][i] = s.box[side][place(i)];
    }
    std::array<std::uint8_t, kSome> visible;
    query_boxes(
        tiles, tiles.projection,
        {box[0].data(), box[1].data(), box[2].data(), box[3].data(), box[4].data(), box[5].data(), count},
        visible.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (visible[i]) prefetch_group(mesh, s.group[place(i)]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (visible[i]) draw_group(tiles, mesh, transform, s.group[place(i)]);
    }
  }
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(draw_one);
HWY_EXPORT(draw_triangles);

void draw_convex(DepthTiles& tiles, const Convex& polygon) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_one)(tiles, polygon);
}

void draw_mesh(DepthTiles& tiles, const OccluderTopology& mesh, const Affine& transform) {
  MeshScratch& s = tiles.mesh;
  const std::size_t groups = mesh.groups.size();
  if (s.known.size() < groups) {
    for (auto& side : s.box) side.resize(groups);
    s.group.reserve(groups), s.near_first.reserve(groups), s.other.reserve(groups);
    s.facing.resize(groups * OccluderTopology::kGroup);
    s.known.resize(groups, s.turn);
  }
  if (++s.turn == 0) std::fill(s.known.begin(), s.known.end(), 0), s.turn = 1;
  HWY_DYNAMIC_DISPATCH(draw_triangles)(tiles, mesh, transform);
}

}  // namespace sightline::occlusion
#endif
