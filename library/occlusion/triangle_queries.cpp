// Triangles against the tiles, pixel by pixel: what the boxes around them leave.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "library/occlusion/depth_tiles.hpp"

#ifndef SIGHTLINE_CULLING_TRIANGLE_QUERIES_ONCE
#define SIGHTLINE_CULLING_TRIANGLE_QUERIES_ONCE
namespace sightline::occlusion {
namespace {

// About the eye, in double precision.
struct ClipPolygon {
  std::array<std::array<double, 3>, 8> points;
  std::size_t count = 0;
};

// Keeps what lies before the near plane and no farther beyond the image than it is wide: somewhat more than
// that, so that rounding takes nothing away. False of what is no number, and in orthographic views.
bool clip_to_view(const DepthTiles& tiles, ClipPolygon& polygon) {
  const EyeProjection& e = tiles.projection;
  if (e.orthographic) return false;
  const double width = tiles.width, height = tiles.height;
  const auto beyond = [&](const Vec4& row, double sign, double shift) {
    return std::array<double, 3>{sign * row.x + shift * e.w.x, sign * row.y + shift * e.w.y,
                                 sign * row.z + shift * e.w.z};
  };
  const Vec4& near = tiles.rays.near_plane;
  // By a thousandth of its distance, and by what rounding may have moved the corners.
  double slack = 1e-3 * std::fabs(double{near.w}), sum = 0;
  for (const auto& point : std::span(polygon.points).first(polygon.count))
    for (const double side : point) slack = std::max(slack, 1e-6 * std::fabs(side)), sum += side;
  if (!std::isfinite(sum)) return false;
  const std::array<std::array<double, 3>, 5> planes{{{near.x, near.y, near.z},
                                                     beyond(e.x, 1, width),
                                                     beyond(e.x, -1, 2 * width),
                                                     beyond(e.y, 1, height),
                                                     beyond(e.y, -1, 2 * height)}};
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const auto& plane = planes[p];
    const auto at = [&](const std::array<double, 3>& point) {
      const double sum = plane[0] * point[0] + plane[1] * point[1] + plane[2] * point[2];
      return p == 0 ? sum + double{near.w} + slack : sum;
    };
    ClipPolygon out;
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const auto &a = polygon.points[i], &b = polygon.points[(i + 1) % polygon.count];
      const double from = at(a), to = at(b);
      if (from >= 0) out.points[out.count++] = a;
      if ((from >= 0) == (to >= 0)) continue;
      const double part = from / (from - to);
      auto& cut = out.points[out.count++];
      for (std::size_t axis = 0; axis < 3; ++axis) cut[axis] = a[axis] + part * (b[axis] - a[axis]);
    }
    polygon = out;
    if (polygon.count < 3) break;
  }
  return true;
}

}  // namespace
}  // namespace sightline::occlusion
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/occlusion/triangle_queries.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "library/occlusion/depth_query-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// Triangles about the eye.
struct Corners {
  VF x[3], y[3], z[3];
};

// A vector of triangles on the image, grown by what rounding asks: an edge as a side's x = at + slope·y, at
// infinity where it bounds the other side or is too flat to say.
struct GrownTriangles {
  alignas(64) std::array<std::array<float, 16>, 3> slope, left_at, right_at;
  alignas(64) std::array<float, 16> left, right, top, bottom, nearest, at, across, down;
};

constexpr float kRounding = 8 * std::numeric_limits<float>::epsilon();
constexpr float kTooFlat = 1.0f / 64, kTooFarOut = 30000;

// The most that rounding a row's product with any corner can lose.
HWY_INLINE VF error_of(const Vec4& row, const VF& reach) {
  const F f;
  const float size = std::fabs(row.x) + std::fabs(row.y) + std::fabs(row.z);
  return hn::Mul(hn::Set(f, kRounding),
                 hn::Add(hn::Mul(hn::Set(f, size), reach), hn::Set(f, std::fabs(row.w))));
}

// Nearness of the triangles' planes, never less than it is: at + x·across + y·down; where a plane is seen too
// much edge on, the triangle's nearest point.
HWY_INLINE void find_planes(const DepthTiles& tiles, const Corners& q, VF reach, VF nearest,
                            GrownTriangles& out) {
  const F f;
  const PixelRays& rays = tiles.rays;
  const auto cross = [&](VF ay, VF az, VF by, VF bz)
                         HWY_ATTR { return hn::Sub(hn::Mul(ay, bz), hn::Mul(az, by)); };
  const auto dot = [&](VF ax, VF ay, VF az, VF bx, VF by, VF bz) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
  };
  const VF ax = hn::Sub(q.x[1], q.x[0]), ay = hn::Sub(q.y[1], q.y[0]), az = hn::Sub(q.z[1], q.z[0]),
           bx = hn::Sub(q.x[2], q.x[0]), by = hn::Sub(q.y[2], q.y[0]), bz = hn::Sub(q.z[2], q.z[0]);
  const VF nx = cross(ay, az, by, bz), ny = cross(az, ax, bz, bx), nz = cross(ax, ay, bx, by);
  const VF length = hn::Sqrt(dot(nx, ny, nz, nx, ny, nz));
  const VF edges = hn::Sqrt(hn::Mul(dot(ax, ay, az, ax, ay, az), dot(bx, by, bz, bx, by, bz)));
  const VF scale = dot(nx, ny, nz, q.x[0], q.y[0], q.z[0]);
  const auto along = [&](const std::array<float, 3>& v) HWY_ATTR {
    return hn::Div(dot(nx, ny, nz, hn::Set(f, v[0]), hn::Set(f, v[1]), hn::Set(f, v[2])), scale);
  };
  const VF across = along(rays.across), down = along(rays.down), start = along(rays.at);
  // The normal's direction is as uncertain as the triangle is thin, and that tells the more the more the
  // plane is seen edge on.
  const VF doubt = hn::Div(hn::Mul(edges, reach), hn::Abs(scale));
  const VF slack = hn::Mul(nearest, hn::Add(hn::Set(f, 2e-5f), hn::Mul(hn::Set(f, 4e-7f), doubt)));
  const VF slant = hn::Mul(hn::Add(hn::Abs(across), hn::Abs(down)), hn::Set(f, 1.0f / 64));
  const VF at = hn::Add(start, hn::Add(slack, slant));
  // Not for what is no number, either; orthographic views do without.
  const auto sure = hn::And(hn::And(hn::Lt(doubt, hn::Set(f, 1e4f)), hn::Gt(length, hn::Zero(f))),
                            hn::Lt(hn::Abs(hn::Add(at, slant)), hn::Set(f, 1e30f)));
  const bool flat = tiles.projection.orthographic;
  const VF none = hn::Zero(f);
  hn::Store(flat ? nearest : hn::IfThenElse(sure, at, nearest), f, out.at.data());
  hn::Store(flat ? none : hn::IfThenElseZero(sure, across), f, out.across.data());
  hn::Store(flat ? none : hn::IfThenElseZero(sure, down), f, out.down.data());
}

// Whether some pixel of triangle i lies nearer than the occluders.
HWY_INLINE bool seen(const DepthTiles& tiles, const GrownTriangles& t, std::size_t i) {
  const F f;
  const TileRange range = tiles_of(tiles, t.left[i], t.right[i], t.top[i], t.bottom[i]);
  const VF across = hn::Set(f, t.across[i]), down = hn::Set(f, t.down[i]), most = hn::Set(f, t.nearest[i]);
  Spans spans;
  for (std::uint32_t ty = range.begin_y; ty < range.end_y; ++ty) {
    const std::size_t line = (ty - range.begin_y) % 2 * kTile;
    if (line == 0)
      spans = spans_of<3>(t, i, static_cast<float>(ty * kTile) + 0.5f, static_cast<float>(tiles.width));
    for (std::uint32_t tx = range.begin_x; tx < range.end_x; ++tx) {
      const std::size_t tile = std::size_t{ty} * tiles.stride + tx;
      if (t.nearest[i] < tiles.farthest[tile]) continue;
      const std::uint64_t pixels = pixels_of(spans, line, tx * kTile);
      if (pixels == 0) continue;
      if (!(tiles.nearest[tile] > -kInfinity)) return true;
      const VF x = hn::Set(f, static_cast<float>(tx * kTile) + 0.5f),
               y = hn::Set(f, static_cast<float>(ty * kTile) + 0.5f);
      auto open = hn::Lt(most, most);
      for (std::size_t at = 0; at < 64; at += hn::Lanes(f)) {
        const VF column = hn::Add(x, hn::Load(f, kColumn + at)), row = hn::Add(y, hn::Load(f, kRow + at));
        const VF plane = hn::Add(hn::Add(hn::Set(f, t.at[i]), hn::Mul(across, column)), hn::Mul(down, row));
        const auto nearer = hn::Ge(hn::Min(plane, most), hn::Load(f, &tiles.nearness[tile * 64 + at]));
        open = hn::Or(open, hn::And(nearer, pixels_at(pixels, at)));
      }
      if (!hn::AllFalse(f, open)) return true;
    }
  }
  return false;
}

HWY_INLINE VF reach_of(const Corners& q) {
  VF reach = hn::Zero(F());
  for (std::size_t k = 0; k < 3; ++k)
    reach = hn::Max(reach, hn::Max(hn::Max(hn::Abs(q.x[k]), hn::Abs(q.y[k])), hn::Abs(q.z[k])));
  return reach;
}

// Those that lie wholly to one side of what is in view.
HWY_INLINE std::uint32_t beyond_a_side(const DepthTiles& tiles, const Corners& q, VF error_x, VF error_y,
                                       VF error_w) {
  const F f;
  const EyeProjection& e = tiles.projection;
  const VF width = hn::Set(f, static_cast<float>(tiles.width)),
           height = hn::Set(f, static_cast<float>(tiles.height));
  auto left = hn::FirstN(f, hn::Lanes(f)), right = left, above = left, below = left;
  const VF right_error = hn::Add(error_x, hn::Mul(width, error_w)),
           below_error = hn::Add(error_y, hn::Mul(height, error_w));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto dot = [&](const Vec4& row) HWY_ATTR { return dot_row(row, q.x[k], q.y[k], q.z[k]); };
    const VF x = dot(e.x), y = dot(e.y), w = dot(e.w);
    left = hn::And(left, hn::Lt(x, hn::Neg(error_x)));
    right = hn::And(right, hn::Gt(hn::Sub(x, hn::Mul(width, w)), right_error));
    above = hn::And(above, hn::Lt(y, hn::Neg(error_y)));
    below = hn::And(below, hn::Gt(hn::Sub(y, hn::Mul(height, w)), below_error));
  }
  return bits_of(hn::Or(hn::Or(left, right), hn::Or(above, below)));
}

bool clipped_seen(const DepthTiles& tiles, const Corners& whole, std::size_t i);

// A vector of triangles, parts of the triangles `whole`; of those beyond `count` nothing is said.
template <bool kMayClip>
HWY_INLINE bool some_seen(const DepthTiles& tiles, const Corners& q, const Corners& whole,
                          std::size_t count) {
  const F f;
  const EyeProjection& e = tiles.projection;
  const VF zero = hn::Zero(f), infinity = hn::Set(f, kInfinity);
  const VF reach = reach_of(whole);
  const VF error_x = error_of(e.x, reach), error_y = error_of(e.y, reach), error_w = error_of(e.w, reach);
  VF x[3], y[3];
  VF left = infinity, top = infinity, least_w = infinity;
  VF right = hn::Neg(infinity), bottom = right, most_w = right, nearest = right;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto dot = [&](const Vec4& row) HWY_ATTR { return dot_row(row, q.x[k], q.y[k], q.z[k]); };
    const VF w = dot(e.w), over_w = hn::Div(hn::Set(f, 1.0f), w);
    x[k] = hn::Mul(dot(e.x), over_w), y[k] = hn::Mul(dot(e.y), over_w);
    least_w = hn::Min(least_w, w), most_w = hn::Max(most_w, w);
    nearest = hn::Max(nearest, dot(e.nearness));
    left = hn::Min(left, x[k]), right = hn::Max(right, x[k]);
    top = hn::Min(top, y[k]), bottom = hn::Max(bottom, y[k]);
  }
  const auto before = hn::Gt(least_w, hn::Add(error_w, error_w));
  const auto behind = hn::Lt(most_w, hn::Neg(error_w));
  const VF over_least = hn::Div(hn::Set(f, 1.0f), hn::Sub(least_w, error_w));
  if (e.orthographic) {
    nearest = hn::Add(nearest, error_of(e.nearness, reach));
  } else {
    nearest = hn::Mul(over_least, hn::Set(f, 1 + 1e-6f));
  }
  const VF widest = hn::Max(hn::Max(hn::Abs(left), hn::Abs(right)), hn::Max(hn::Abs(top), hn::Abs(bottom)));
  const VF slack = hn::Add(hn::Mul(hn::Add(hn::Max(error_x, error_y), hn::Mul(widest, error_w)), over_least),
                           hn::Add(hn::Set(f, 1.0f / 128), hn::Mul(hn::Set(f, kInsetGrowth), widest)));
  left = hn::Sub(left, slack), right = hn::Add(right, slack);
  top = hn::Sub(top, slack), bottom = hn::Add(bottom, slack);
  std::array<std::uint8_t, 16> visible;
  test_rectangles(tiles, {left, right, top, bottom, nearest, before}, count, visible.data());
  std::uint32_t rest = 0;
  for (std::size_t i = 0; i < count; ++i) rest |= std::uint32_t{visible[i]} << i;
  rest &= ~bits_of(behind);
  if (rest == 0) return false;
  // Parts behind the eye, or far out, have no place on the image.
  std::uint32_t clipped = rest & ~bits_of(hn::And(before, hn::Lt(widest, hn::Set(f, kTooFarOut))));
  if (clipped != 0) {
    if (!kMayClip) return true;
    rest &= ~clipped;
    clipped &= ~beyond_a_side(tiles, q, error_x, error_y, error_w);
  }

  GrownTriangles t;
  const VF area = hn::Sub(hn::Mul(hn::Sub(x[1], x[0]), hn::Sub(y[2], y[0])),
                          hn::Mul(hn::Sub(x[2], x[0]), hn::Sub(y[1], y[0])));
  const auto to_right = hn::Gt(area, zero);
  // Which side of a triangle too thin an edge lies on is not certain.
  const auto thick =
      hn::Gt(hn::Abs(area), hn::Mul(slack, hn::Add(hn::Sub(right, left), hn::Sub(bottom, top))));
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const VF rise = hn::Sub(y[next], y[k]), slope = hn::Div(hn::Sub(x[next], x[k]), rise),
             at = hn::Sub(x[k], hn::Mul(y[k], slope));
    const VF outwards = hn::Mul(slack, hn::Add(hn::Set(f, 1.0f), hn::Abs(slope)));
    const auto bounds = hn::And(thick, hn::Ge(hn::Abs(rise), hn::Set(f, kTooFlat)));
    const auto on_right = hn::Not(hn::Xor(hn::Gt(rise, zero), to_right));
    hn::Store(hn::IfThenElseZero(bounds, slope), f, t.slope[k].data());
    hn::Store(hn::IfThenElse(hn::And(bounds, on_right), hn::Add(at, outwards), infinity), f,
              t.right_at[k].data());
    hn::Store(hn::IfThenElse(hn::AndNot(on_right, bounds), hn::Sub(at, outwards), hn::Neg(infinity)), f,
              t.left_at[k].data());
  }
  find_planes(tiles, whole, reach, nearest, t);
  hn::Store(left, f, t.left.data()), hn::Store(right, f, t.right.data());
  hn::Store(top, f, t.top.data()), hn::Store(bottom, f, t.bottom.data());
  hn::Store(nearest, f, t.nearest.data());
  for (; rest != 0; rest &= rest - 1) {
    if (seen(tiles, t, static_cast<std::size_t>(std::countr_zero(rest)))) return true;
  }
  if constexpr (kMayClip) {
    for (; clipped != 0; clipped &= clipped - 1) {
      if (clipped_seen(tiles, whole, static_cast<std::size_t>(std::countr_zero(clipped)))) return true;
    }
  }
  return false;
}

// What of triangle i lies before the near plane, and not far beyond the image. False is certain.
bool clipped_seen(const DepthTiles& tiles, const Corners& whole, std::size_t i) {
  const F f;
  alignas(64) std::array<std::array<float, 16>, 9> in;
  ClipPolygon polygon;
  for (std::size_t k = 0; k < 3; ++k) {
    hn::Store(whole.x[k], f, in[3 * k].data());
    hn::Store(whole.y[k], f, in[3 * k + 1].data());
    hn::Store(whole.z[k], f, in[3 * k + 2].data());
    polygon.points[k] = {in[3 * k][i], in[3 * k + 1][i], in[3 * k + 2][i]};
  }
  polygon.count = 3;
  if (!clip_to_view(tiles, polygon)) return true;
  if (polygon.count < 3) return false;
  // A fan of triangles, each on the plane of the whole.
  Corners its;
  for (std::size_t k = 0; k < 3; ++k) {
    its.x[k] = hn::Set(f, in[3 * k][i]), its.y[k] = hn::Set(f, in[3 * k + 1][i]);
    its.z[k] = hn::Set(f, in[3 * k + 2][i]);
  }
  const std::size_t triangles = polygon.count - 2;
  for (std::size_t first = 0; first < triangles; first += hn::Lanes(f)) {
    for (std::size_t lane = 0; lane < hn::Lanes(f); ++lane) {
      const std::size_t t = std::min(first + lane, triangles - 1);
      const std::size_t from[3] = {0, t + 1, t + 2};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t a = 0; a < 3; ++a)
          in[3 * k + a][lane] = static_cast<float>(polygon.points[from[k]][a]);
      }
    }
    Corners part;
    for (std::size_t k = 0; k < 3; ++k) {
      part.x[k] = hn::Load(f, in[3 * k].data()), part.y[k] = hn::Load(f, in[3 * k + 1].data());
      part.z[k] = hn::Load(f, in[3 * k + 2].data());
    }
    if (some_seen<false>(tiles, part, its, std::min(hn::Lanes(f), triangles - first))) return true;
  }
  return false;
}

bool query_all_triangles(const DepthTiles& tiles, const TriangleBlock* blocks, std::size_t triangles) {
  const F f;
  const EyeProjection& e = tiles.projection;
  for (std::size_t first = 0; first < triangles; first += hn::Lanes(f)) {
    const auto& from = blocks[first / TriangleBlock::kSize].corners;
    const std::size_t lane = first % TriangleBlock::kSize;
    const auto about_eye = [&](std::size_t k, std::size_t axis, float high, float low) HWY_ATTR {
      return hn::Sub(hn::Sub(hn::Load(f, &from[k][axis][lane]), hn::Set(f, high)), hn::Set(f, low));
    };
    Corners q;
    for (std::size_t k = 0; k < 3; ++k) {
      q.x[k] = about_eye(k, 0, e.eye_high.x, e.eye_low.x);
      q.y[k] = about_eye(k, 1, e.eye_high.y, e.eye_low.y);
      q.z[k] = about_eye(k, 2, e.eye_high.z, e.eye_low.z);
    }
    if (some_seen<true>(tiles, q, q, std::min(hn::Lanes(f), triangles - first))) return true;
  }
  return false;
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(query_all_triangles);

void TriangleBlock::take(std::span<const Vec3> triangles, std::size_t first) noexcept {
  const std::size_t last = triangles.size() / 3 - 1;
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& c = triangles[3 * std::min(first + i, last) + k];
      corners[k][0][i] = c.x, corners[k][1][i] = c.y, corners[k][2][i] = c.z;
    }
  }
}

void prefetch(std::span<const TriangleBlock> blocks) noexcept {
  const std::span<const std::byte> bytes =
      std::as_bytes(blocks.first(std::min<std::size_t>(blocks.size(), 1)));
  for (std::size_t at = 0; at < bytes.size(); at += 64) hwy::Prefetch(&bytes[at]);
}

bool query_triangles(const DepthTiles& tiles, std::span<const TriangleBlock> blocks,
                     std::size_t count) noexcept {
  return HWY_DYNAMIC_DISPATCH(query_all_triangles)(tiles, blocks.data(), count);
}

bool query_triangles(const DepthTiles& tiles, std::span<const Vec3> corners) noexcept {
  const std::size_t triangles = corners.size() / 3;
  TriangleBlock block;
  for (std::size_t first = 0; first < triangles; first += TriangleBlock::kSize) {
    block.take(corners, first);
    if (query_triangles(tiles, {&block, 1}, std::min(TriangleBlock::kSize, triangles - first))) return true;
  }
  return false;
}

}  // namespace sightline::occlusion
#endif
