// Spheres against the tiles: the tight rectangle of a sphere's image, and its nearest depth.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "library/occlusion/depth_tiles.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/occlusion/sphere_queries.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/occlusion/depth_query-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// Spheres about the eye.
struct Balls {
  VF x, y, z, radius;
};

// Least and greatest pixel coordinate of the points of a ball: the roots X of
// (row - X·w)·centre = ±radius·|row - X·w|.
HWY_INLINE void image_of(const Vec4& row, const Vec4& w, const Balls& b, bool orthographic, VF& low,
                         VF& high) {
  const F f;
  const auto dot3 = [](const Vec4& u, const Vec4& v) { return u.x * v.x + u.y * v.y + u.z * v.z; };
  const VF at = dot_row(row, b.x, b.y, b.z);
  if (orthographic) {
    const VF reach = hn::Mul(b.radius, hn::Set(f, std::sqrt(dot3(row, row)) / w.w));
    const VF middle = hn::Mul(at, hn::Set(f, 1 / w.w));
    low = hn::Sub(middle, reach), high = hn::Add(middle, reach);
    return;
  }
  const VF depth = dot_row(w, b.x, b.y, b.z), square = hn::Mul(b.radius, b.radius);
  const float ww = dot3(w, w), rw = dot3(row, w), rr = dot3(row, row);
  const auto across = [&](float r, float v) HWY_ATTR {
    return hn::Sub(hn::Mul(depth, hn::Set(f, r)), hn::Mul(at, hn::Set(f, v)));
  };
  const VF nx = across(row.x, w.x), ny = across(row.y, w.y), nz = across(row.z, w.z);
  const VF length = hn::Add(hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny)), hn::Mul(nz, nz));
  const VF under = hn::Sub(length, hn::Mul(square, hn::Set(f, std::max(0.0f, rr * ww - rw * rw))));
  const VF spread = hn::Mul(b.radius, hn::Sqrt(hn::Max(under, hn::Zero(f))));
  const VF middle = hn::Sub(hn::Mul(at, depth), hn::Mul(square, hn::Set(f, rw)));
  const VF over = hn::Div(hn::Set(f, 1.0f), hn::Sub(hn::Mul(depth, depth), hn::Mul(square, hn::Set(f, ww))));
  low = hn::Mul(hn::Sub(middle, spread), over), high = hn::Mul(hn::Add(middle, spread), over);
}

void query_all_spheres(const DepthTiles& tiles, const EyeProjection& e, const SphereSpan& spheres,
                       std::uint8_t* visible) {
  const F f;
  const std::size_t lanes = hn::Lanes(f);
  const float w_length = std::sqrt(e.w.x * e.w.x + e.w.y * e.w.y + e.w.z * e.w.z);
  for (std::size_t first = 0; first < spheres.count; first += lanes) {
    const std::size_t count = std::min(lanes, spheres.count - first);
    const float* from[4] = {spheres.x + first, spheres.y + first, spheres.z + first, spheres.radius + first};
    // The last vector repeats spheres rather than reading beyond them.
    alignas(64) std::array<std::array<float, 16>, 4> tail;
    if (count < lanes) {
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t i = 0; i < lanes; ++i) tail[a][i] = from[a][std::min(i, count - 1)];
        from[a] = tail[a].data();
      }
    }
    const auto about_eye = [&](std::size_t a, float high, float low) HWY_ATTR {
      return hn::Sub(hn::Sub(hn::LoadU(f, from[a]), hn::Set(f, high)), hn::Set(f, low));
    };
    Balls b{about_eye(0, e.eye_high.x, e.eye_low.x), about_eye(1, e.eye_high.y, e.eye_low.y),
            about_eye(2, e.eye_high.z, e.eye_low.z), hn::LoadU(f, from[3])};
    // Larger by what the subtractions can have lost.
    const VF reach = hn::Add(hn::Abs(b.x), hn::Add(hn::Abs(b.y), hn::Abs(b.z)));
    b.radius = hn::Add(hn::Mul(b.radius, hn::Set(f, 1 + 1e-6f)), hn::Mul(reach, hn::Set(f, 1e-6f)));
    VF left, right, top, bottom, nearest;
    image_of(e.x, e.w, b, e.orthographic, left, right);
    image_of(e.y, e.w, b, e.orthographic, top, bottom);
    auto before = hn::Eq(reach, reach);
    if (e.orthographic) {
      nearest = hn::Add(dot_row(e.nearness, b.x, b.y, b.z), b.radius);
      nearest = hn::Add(nearest, hn::Mul(reach, hn::Set(f, 1e-6f)));
    } else {
      const VF depth = dot_row(e.w, b.x, b.y, b.z);
      const VF least = hn::Sub(depth, hn::Mul(b.radius, hn::Set(f, w_length * (1 + 1e-6f))));
      // Close to the eye's plane the roots lose their digits.
      before = hn::Gt(least, hn::Mul(depth, hn::Set(f, 1e-2f)));
      nearest = hn::Mul(hn::Div(hn::Set(f, 1.0f), least), hn::Set(f, 1 + 1e-6f));
    }
    const VF widest = hn::Max(hn::Max(hn::Abs(left), hn::Abs(right)), hn::Max(hn::Abs(top), hn::Abs(bottom)));
    const VF slack = hn::Add(hn::Set(f, 1.0f / 64), hn::Mul(widest, hn::Set(f, 2e-5f)));
    test_rectangles(tiles,
                    {hn::Sub(left, slack), hn::Add(right, slack), hn::Sub(top, slack), hn::Add(bottom, slack),
                     nearest, before},
                    count, visible + first);
  }
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(query_all_spheres);

void query_spheres(const DepthTiles& tiles, const EyeProjection& projection, const SphereSpan& spheres,
                   std::uint8_t* visible) noexcept {
  HWY_DYNAMIC_DISPATCH(query_all_spheres)(tiles, projection, spheres, visible);
}

}  // namespace sightline::occlusion
#endif
