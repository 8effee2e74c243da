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

// A vector of spheres about the eye.
struct WideSpheres {
  VPoints centre;
  VF radius;
  VF reach;  // the sum of the centre's coordinates, whatever their signs
};

HWY_INLINE WideSpheres spheres_of(const EyeProjection& e, const std::array<const float*, 4>& from) {
  const F f;
  WideSpheres s;
  s.centre = about_eye(e, {hn::LoadU(f, from[0]), hn::LoadU(f, from[1]), hn::LoadU(f, from[2])});
  s.reach = hn::Add(hn::Abs(s.centre.x), hn::Add(hn::Abs(s.centre.y), hn::Abs(s.centre.z)));
  // Larger by what the subtractions can have lost.
  s.radius = hn::Add(hn::Mul(hn::LoadU(f, from[3]), hn::Set(f, 1 + kSphereGrowth)),
                     hn::Mul(s.reach, hn::Set(f, kSphereGrowth)));
  return s;
}

// Least and greatest pixel coordinate of a sphere's points: the roots X of
// (row - X·w)·centre = ±radius·|row - X·w|.
HWY_INLINE void image_of(const Vec4& row, const Vec4& w, const WideSpheres& s, bool orthographic, VF& low,
                         VF& high) {
  const F f;
  const auto dot3 = [](const Vec4& u, const Vec4& v) { return u.x * v.x + u.y * v.y + u.z * v.z; };
  const VF at = dot_row(row, s.centre);
  if (orthographic) {
    const VF reach = hn::Mul(s.radius, hn::Set(f, std::sqrt(dot3(row, row)) / w.w));
    const VF middle = hn::Mul(at, hn::Set(f, 1 / w.w));
    low = hn::Sub(middle, reach), high = hn::Add(middle, reach);
    return;
  }
  const VF depth = dot_row(w, s.centre), square = hn::Mul(s.radius, s.radius);
  const float ww = dot3(w, w), rw = dot3(row, w), rr = dot3(row, row);
  const auto across = [&](float r, float v) HWY_ATTR {
    return hn::Sub(hn::Mul(depth, hn::Set(f, r)), hn::Mul(at, hn::Set(f, v)));
  };
  const VF nx = across(row.x, w.x), ny = across(row.y, w.y), nz = across(row.z, w.z);
  const VF length = hn::Add(hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny)), hn::Mul(nz, nz));
  const VF under = hn::Sub(length, hn::Mul(square, hn::Set(f, std::max(0.0f, rr * ww - rw * rw))));
  const VF spread = hn::Mul(s.radius, hn::Sqrt(hn::Max(under, hn::Zero(f))));
  const VF middle = hn::Sub(hn::Mul(at, depth), hn::Mul(square, hn::Set(f, rw)));
  const VF over = hn::Div(hn::Set(f, 1.0f), hn::Sub(hn::Mul(depth, depth), hn::Mul(square, hn::Set(f, ww))));
  low = hn::Mul(hn::Sub(middle, spread), over), high = hn::Mul(hn::Add(middle, spread), over);
}

HWY_INLINE Question question_of(const EyeProjection& e, const WideSpheres& s, float margin) {
  const F f;
  Question q;
  Rectangles on_image;
  image_of(e.x, e.w, s, e.orthographic, on_image.left, on_image.right);
  image_of(e.y, e.w, s, e.orthographic, on_image.top, on_image.bottom);
  if (e.orthographic) {
    q.sure = hn::Eq(s.reach, s.reach);
    q.nearest = hn::Add(hn::Add(dot_row(e.nearness, s.centre), s.radius),
                        hn::Mul(s.reach, hn::Set(f, kSphereGrowth)));
  } else {
    const float w_length = std::sqrt(e.w.x * e.w.x + e.w.y * e.w.y + e.w.z * e.w.z);
    const VF depth = dot_row(e.w, s.centre);
    const VF least = hn::Sub(depth, hn::Mul(s.radius, hn::Set(f, w_length * (1 + kReciprocalRounding))));
    // Close to the eye's plane the roots lose their digits.
    q.sure = hn::Gt(least, hn::Mul(depth, hn::Set(f, kLeastClearance)));
    q.nearest = hn::Mul(hn::Div(hn::Set(f, 1.0f), least), hn::Set(f, 1 + kReciprocalRounding));
  }
  const VF slack = hn::Add(hn::Set(f, kSphereSlack + margin),
                           hn::Mul(widest_of(on_image), hn::Set(f, kSphereSlackGrowth)));
  q.within = grown(on_image, slack);
  return q;
}

void query_all_spheres(const DepthTiles& tiles, const EyeProjection& e, const SphereSpan& spheres,
                       std::uint8_t* visible) {
  const std::array<const float*, 4> arrays{spheres.x, spheres.y, spheres.z, spheres.radius};
  answer_all(tiles, arrays, spheres.count, visible,
             [&](const auto& from) HWY_ATTR { return question_of(e, spheres_of(e, from), tiles.around()); });
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
