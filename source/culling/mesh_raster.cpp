// Triangles of meshes into the tiles, set up a vector at a time; and single polygons.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "culling/depth_tiles.hpp"
#include "scene/scale_bounds.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "culling/mesh_raster.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "culling/depth_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::culling::HWY_NAMESPACE {

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

// Moves the vertices to the world and the eye, and projects them.
void project_vertices(DepthTiles& out, const OccluderTopology& mesh, const Affine& transform) {
  const F f;
  const EyeProjection& e = out.projection;
  MeshScratch& s = out.mesh;
  const std::size_t n = mesh.x.size();  // padded
  for (auto* v : {&s.x, &s.y, &s.near, &s.clearance, &s.eye_x, &s.eye_y, &s.eye_z}) {
    if (v->size() < n) v->resize(n);
  }
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const V3 p{hn::Load(f, &mesh.x[i]), hn::Load(f, &mesh.y[i]), hn::Load(f, &mesh.z[i])};
    const auto about_eye = [&](const Vec4& row, float high, float low) HWY_ATTR {
      return hn::Sub(hn::Sub(dot_row(row, p.x, p.y, p.z), hn::Set(f, high)), hn::Set(f, low));
    };
    const VF x = about_eye(transform.rows[0], e.eye_high.x, e.eye_low.x),
             y = about_eye(transform.rows[1], e.eye_high.y, e.eye_low.y),
             z = about_eye(transform.rows[2], e.eye_high.z, e.eye_low.z);
    const VF over_w = hn::Div(hn::Set(f, 1.0f), dot_row(e.w, x, y, z));
    hn::Store(x, f, &s.eye_x[i]);
    hn::Store(y, f, &s.eye_y[i]);
    hn::Store(z, f, &s.eye_z[i]);
    hn::Store(hn::Mul(dot_row(e.x, x, y, z), over_w), f, &s.x[i]);
    hn::Store(hn::Mul(dot_row(e.y, x, y, z), over_w), f, &s.y[i]);
    hn::Store(e.orthographic ? dot_row(e.nearness, x, y, z) : over_w, f, &s.near[i]);
    hn::Store(dot_row(out.rays.near_plane, x, y, z), f, &s.clearance[i]);
  }
}

// Which way a triangle turns on the image: 1 or -1; 0: too small; kCut: the near plane cuts it.
constexpr float kCut = 2;

HWY_INLINE void find_facing(MeshScratch& s, const OccluderTopology& mesh, std::size_t first,
                            std::size_t end) {
  const F f;
  const I i32;
  for (std::size_t t = first; t < end; t += hn::Lanes(f)) {
    const VI a = hn::Load(i32, &mesh.corner[0][t]), b = hn::Load(i32, &mesh.corner[1][t]),
             c = hn::Load(i32, &mesh.corner[2][t]);
    const auto at = [&](const partition::AlignedVector<float>& from, VI index)
                        HWY_ATTR { return hn::GatherIndex(f, from.data(), index); };
    const VF ca = at(s.clearance, a), cb = at(s.clearance, b), cc = at(s.clearance, c);
    const VF ax = at(s.x, a), ay = at(s.y, a);
    const VF area = hn::Sub(hn::Mul(hn::Sub(at(s.x, b), ax), hn::Sub(at(s.y, c), ay)),
                            hn::Mul(hn::Sub(at(s.x, c), ax), hn::Sub(at(s.y, b), ay)));
    const VF zero = hn::Zero(f), one = hn::Set(f, 1.0f), least = hn::Set(f, 0.02f);
    VF facing = hn::IfThenElse(hn::Gt(area, least), one,
                               hn::IfThenElse(hn::Lt(area, hn::Neg(least)), hn::Neg(one), zero));
    // Not a number counts as behind, too.
    const auto before = [&](VF v) HWY_ATTR { return hn::Ge(v, zero); };
    const auto all = hn::And(hn::And(before(ca), before(cb)), before(cc)),
               some = hn::Or(hn::Or(before(ca), before(cb)), before(cc));
    facing = hn::IfThenElse(all, facing, hn::IfThenElse(some, hn::Set(f, kCut), zero));
    hn::Store(facing, f, &s.facing[t]);
  }
}

// A vector of triangles, ready to be drawn.
struct Triangles {
  alignas(64) std::array<float, 16> left, right, top, bottom, nearest, at, across, down;
  alignas(64) std::array<std::array<float, 16>, 3> slope, edge_at;
  std::array<std::uint32_t, 3> on_right, steep;  // a bit a triangle: the edge bounds it to the right
  std::uint32_t drawn = 0, cut = 0;
};

// Triangles t … of the mesh; false where there is nothing to draw.
HWY_INLINE bool set_up(const DepthTiles& tiles, const OccluderTopology& mesh, std::size_t t, Triangles& out) {
  const F f;
  const I i32;
  const MeshScratch& s = tiles.mesh;
  const auto at = [&](const partition::AlignedVector<float>& from, VI index)
                      HWY_ATTR { return hn::GatherIndex(f, from.data(), index); };
  const VF facing = hn::Load(f, &s.facing[t]), zero = hn::Zero(f), one = hn::Set(f, 1.0f);
  out.cut = bits_of(hn::Eq(facing, hn::Set(f, kCut)));
  auto drawn = hn::Eq(hn::Abs(facing), one);
  out.drawn = 0;
  if (hn::AllFalse(f, drawn)) return out.cut != 0;
  VI corner[3];
  VF x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    corner[k] = hn::Load(i32, &mesh.corner[k][t]);
    x[k] = at(s.x, corner[k]), y[k] = at(s.y, corner[k]);
  }
  const VF left = hn::Min(hn::Min(x[0], x[1]), x[2]), right = hn::Max(hn::Max(x[0], x[1]), x[2]);
  VF top = hn::Min(hn::Min(y[0], y[1]), y[2]), bottom = hn::Max(hn::Max(y[0], y[1]), y[2]);
  // Nothing where no pixel centre lies between the sides, nor beyond the image.
  const VF half = hn::Set(f, 0.5f);
  const auto holds_centre = [&](VF low, VF high, float size) HWY_ATTR {
    const VF first = hn::Max(hn::Ceil(hn::Sub(low, half)), zero),
             last = hn::Min(hn::Floor(hn::Sub(high, half)), hn::Set(f, size - 1));
    return hn::Le(first, last);
  };
  drawn = hn::And(drawn, hn::And(holds_centre(left, right, static_cast<float>(tiles.width)),
                                 holds_centre(top, bottom, static_cast<float>(tiles.height))));
  if (hn::AllFalse(f, drawn)) return out.cut != 0;

  const auto eye = [&](int k) HWY_ATTR {
    return V3{at(s.eye_x, corner[k]), at(s.eye_y, corner[k]), at(s.eye_z, corner[k])};
  };
  const V3 p = eye(0), q = eye(1), r = eye(2);
  const V3 normal = cross(minus(q, p), minus(r, p));
  const VF length = hn::Sqrt(dot(normal, normal));
  const V3 unit{hn::Div(normal.x, length), hn::Div(normal.y, length), hn::Div(normal.z, length)};
  const VF nearest = hn::Max(hn::Max(at(s.near, corner[0]), at(s.near, corner[1])), at(s.near, corner[2]));
  const auto most = [&](const V3& v)
                        HWY_ATTR { return hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z)); };
  const VF reach = hn::Max(hn::Max(most(p), most(q)), most(r));
  const PixelRays& rays = tiles.rays;
  const bool orthographic = tiles.projection.orthographic;
  const VF plane_at = dot(unit, p);
  const VF scale = orthographic ? dot(unit, rays.forward) : plane_at;
  // Seen too much edge on, the plane says nothing.
  const VF least =
      orthographic ? hn::Set(f, 1e-4f) : hn::Add(hn::Mul(hn::Set(f, 1e-5f), reach), hn::Set(f, 1e-6f));
  drawn = hn::And(drawn, hn::And(hn::Gt(length, zero), hn::Gt(hn::Abs(scale), least)));
  const VF across = hn::Div(dot(unit, rays.across), scale), down = hn::Div(dot(unit, rays.down), scale);
  const VF ray_at = dot(unit, rays.at);
  const VF start = hn::Div(orthographic ? hn::Sub(ray_at, plane_at) : ray_at, scale);
  hn::Store(moved_back(start, across, down, nearest), f, out.at.data());
  hn::Store(across, f, out.across.data());
  hn::Store(down, f, out.down.data());
  hn::Store(nearest, f, out.nearest.data());

  const VF farthest_out =
      hn::Max(hn::Max(hn::Abs(left), hn::Abs(right)), hn::Max(hn::Abs(top), hn::Abs(bottom)));
  const VF inset = hn::Add(hn::Set(f, kInset), hn::Mul(hn::Set(f, kInsetGrowth), farthest_out));
  const auto to_right = hn::Gt(facing, zero);
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const VI other = hn::Load(i32, &mesh.neighbour[k][t]);
    const auto has_other = hn::Gt(other, hn::Set(i32, -1));
    const VF others = at(s.facing, hn::Max(other, hn::Zero(i32)));
    const auto seam = hn::And(hn::RebindMask(f, has_other), hn::Eq(others, facing));
    const VF by_seam = hn::IfThenZeroElse(seam, inset);
    const auto falls = hn::Gt(y[next], y[k]);
    const auto on_right = hn::Not(hn::Xor(falls, to_right));
    // From the vertex of lower number, so that both sides of a seam compute the same bits.
    const auto turned = hn::RebindMask(f, hn::Gt(corner[k], corner[next]));
    const VF ax = hn::IfThenElse(turned, x[next], x[k]), ay = hn::IfThenElse(turned, y[next], y[k]),
             bx = hn::IfThenElse(turned, x[k], x[next]), by = hn::IfThenElse(turned, y[k], y[next]);
    const VF rise = hn::Sub(by, ay), slope = hn::Div(hn::Sub(bx, ax), rise),
             edge_at = hn::Sub(ax, hn::Mul(ay, slope));
    const VF inwards = hn::Mul(by_seam, hn::Add(one, hn::Abs(slope)));
    const auto steep = hn::Ge(hn::Abs(rise), hn::Set(f, kFlat));
    out.steep[k] = bits_of(steep);
    out.on_right[k] = bits_of(on_right);
    hn::Store(slope, f, out.slope[k].data());
    hn::Store(hn::IfThenElse(on_right, hn::Sub(edge_at, inwards), hn::Add(edge_at, inwards)), f,
              out.edge_at[k].data());
    // A flat edge that is no seam bounds the rows.
    const auto bounds = hn::AndNot(seam, hn::Not(steep));
    const auto above = hn::Gt(y[(k + 2) % 3], ay);
    top = hn::IfThenElse(hn::And(bounds, above), hn::Max(top, hn::Add(hn::Max(ay, by), inset)), top);
    bottom =
        hn::IfThenElse(hn::AndNot(above, bounds), hn::Min(bottom, hn::Sub(hn::Min(ay, by), inset)), bottom);
  }
  hn::Store(left, f, out.left.data());
  hn::Store(right, f, out.right.data());
  hn::Store(top, f, out.top.data());
  hn::Store(bottom, f, out.bottom.data());
  out.drawn = bits_of(drawn);
  return (out.drawn | out.cut) != 0;
}

float length_of(const Vec4& row) {
  return std::sqrt(row.x * row.x + row.y * row.y + row.z * row.z);
}

// The groups that the image may hold, near ones first. A group left out by mistake would only hide less.
void find_groups(DepthTiles& tiles, const OccluderTopology& mesh, const Affine& transform) {
  const EyeProjection& e = tiles.projection;
  const auto width = static_cast<float>(tiles.width), height = static_cast<float>(tiles.height);
  const auto minus = [](float scale, const Vec4& a, const Vec4& b) {
    return Vec4{scale * a.x - b.x, scale * a.y - b.y, scale * a.z - b.z, scale * a.w - b.w};
  };
  const Vec4 sides[5] = {e.x, minus(width, e.w, e.x), e.y, minus(height, e.w, e.y), tiles.rays.near_plane};
  float lengths[5];
  for (int k = 0; k < 5; ++k) lengths[k] = length_of(sides[k]);
  const float scale = scene::scale_bounds(transform).most, w_length = length_of(e.w);
  tiles.mesh.seen.clear();
  for (std::uint32_t g = 0; g < mesh.groups.size(); ++g) {
    const Sphere& ball = mesh.groups[g].ball;
    const Vec3 c = transform_point(transform, ball.centre);
    const float x = (c.x - e.eye_high.x) - e.eye_low.x, y = (c.y - e.eye_high.y) - e.eye_low.y,
                z = (c.z - e.eye_high.z) - e.eye_low.z, r = ball.radius * scale;
    const auto at = [&](const Vec4& row) { return ((row.x * x + row.y * y) + row.z * z) + row.w; };
    bool out = false;
    for (int k = 0; k < 5; ++k) out = out || at(sides[k]) < -r * lengths[k];
    if (out) continue;
    // Bounds of its image, where it lies before the eye: by its nearest depth, which is enough to skip by.
    const float w = at(e.w), least = w - r * w_length;
    if (!std::isfinite(w)) continue;
    MeshScratch::SeenGroup seen{w, kInfinity, 0, width, 0, height, g};
    if (e.orthographic) seen.depth = -at(e.nearness);
    if (!std::isfinite(seen.depth)) continue;
    if (!e.orthographic && least > 0.1f * w) {
      const auto reach = [&](const Vec4& row) {
        return (length_of(row) + std::fabs(at(row) / w) * w_length) * r / least;
      };
      const float px = at(e.x) / w, py = at(e.y) / w, rx = reach(e.x), ry = reach(e.y);
      seen.nearest = 1 / least;
      seen.left = px - rx, seen.right = px + rx, seen.top = py - ry, seen.bottom = py + ry;
    }
    tiles.mesh.seen.push_back(seen);
  }
  std::sort(tiles.mesh.seen.begin(), tiles.mesh.seen.end(), [](const auto& a, const auto& b) {
    return a.depth != b.depth ? a.depth < b.depth : a.group < b.group;
  });
}

HWY_INLINE void draw_group(DepthTiles& tiles, const OccluderTopology& mesh,
                           const OccluderTopology::Group& group) {
  const F f;
  const MeshScratch& s = tiles.mesh;
  Triangles ready;
  for (std::size_t first = group.first; first < group.end; first += hn::Lanes(f)) {
    if (!set_up(tiles, mesh, first, ready)) continue;
    for (std::uint32_t rest = ready.drawn; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const TileRange range = tiles_of(tiles, ready.left[i], ready.right[i], ready.top[i], ready.bottom[i]);
      if (hidden_tiles(tiles, range, ready.nearest[i])) continue;
      Convex out;
      out.left = ready.left[i], out.right = ready.right[i];
      out.top = ready.top[i], out.bottom = ready.bottom[i];
      out.at = ready.at[i], out.across = ready.across[i], out.down = ready.down[i];
      for (std::size_t k = 0; k < 3; ++k) {
        // Written to both lists and counted in one: no branch to guess.
        const std::size_t l = out.left_edges, r = out.right_edges;
        out.left_at[l] = out.right_at[r] = ready.edge_at[k][i];
        out.left_slope[l] = out.right_slope[r] = ready.slope[k][i];
        const std::uint32_t steep = ready.steep[k] >> i & 1, on_right = ready.on_right[k] >> i & 1;
        out.right_edges += steep & on_right;
        out.left_edges += steep & ~on_right & 1;
      }
      draw_polygon(tiles, out, range);
    }
    for (std::uint32_t rest = ready.cut; rest != 0; rest &= rest - 1) {
      const auto& corner = mesh.triangles[first + static_cast<std::size_t>(std::countr_zero(rest))];
      std::array<Vec3, 3> points;
      for (std::size_t k = 0; k < 3; ++k)
        points[k] = {s.eye_x[corner[k]], s.eye_y[corner[k]], s.eye_z[corner[k]]};
      draw_clipped_triangle(tiles, points);
    }
  }
}

void draw_triangles(DepthTiles& tiles, const OccluderTopology& mesh, const Affine& transform) {
  find_groups(tiles, mesh, transform);
  MeshScratch& s = tiles.mesh;
  if (s.seen.empty()) return;
  project_vertices(tiles, mesh, transform);
  // Those of groups out of view count as turned away: their neighbours' edges are then an outline.
  s.facing.assign(mesh.corner[0].size(), 0);
  for (const auto& seen : s.seen)
    find_facing(s, mesh, mesh.groups[seen.group].first, mesh.groups[seen.group].end);
  for (const auto& seen : s.seen) {
    if (seen.nearest < kInfinity &&
        hidden_tiles(tiles, tiles_of(tiles, seen.left, seen.right, seen.top, seen.bottom),
                     seen.nearest * (1 + 1e-5f)))
      continue;
    draw_group(tiles, mesh, mesh.groups[seen.group]);
  }
}

}  // namespace sightline::culling::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::culling {
HWY_EXPORT(draw_one);
HWY_EXPORT(draw_triangles);

void draw_convex(DepthTiles& tiles, const Convex& polygon) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_one)(tiles, polygon);
}

void draw_mesh(DepthTiles& tiles, const OccluderTopology& mesh, const Affine& transform) {
  HWY_DYNAMIC_DISPATCH(draw_triangles)(tiles, mesh, transform);
}

}  // namespace sightline::culling
#endif
