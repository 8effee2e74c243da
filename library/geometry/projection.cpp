#include <sightline/projection.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "library/geometry/box_math.hpp"
#include "library/geometry/error_bounds.hpp"
#include "library/geometry/linear.hpp"

namespace sightline {

using namespace geometry;

namespace {

constexpr Rect kWholePlane{-kInfinity, -kInfinity, kInfinity, kInfinity};

float dot(const Vec4& row, const Vec3& p) {
  return ((row.x * p.x + row.y * p.y) + row.z * p.z) + row.w;
}

float distance(const Vec3& a, const Vec3& b) {
  const float x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

Projector make_projector(const View& view, const Box& extent) noexcept {
  Projector out;
  const Mat4 clip = world_to_clip(view);
  const Vec3 reach = largest(extent);
  double magnitude = 0;
  for (int r = 0; r < 4; ++r) {
    Vec4& row = out.rows[r];
    row = {clip.m[r], clip.m[4 + r], clip.m[8 + r], clip.m[12 + r]};
    if (r != 2) {
      magnitude =
          std::max(magnitude, double{std::fabs(row.x)} * reach.x + double{std::fabs(row.y)} * reach.y +
                                  double{std::fabs(row.z)} * reach.z + std::fabs(row.w));
    }
  }
  out.extent = extent;
  out.coordinate_error = static_cast<float>(kProjectionRounding * magnitude);
  out.eye = eye_position(view);
  out.width = static_cast<float>(view.width);
  out.height = static_cast<float>(view.height);
  out.orthographic = is_orthographic(view);
  // Half the height over tan(fov/2); the larger axis, where pixels are not square.
  const float w_per_metre = std::fabs(view.eye_to_clip.m[out.orthographic ? 15 : 11]);
  out.pixels_per_metre =
      0.5f / w_per_metre *
      std::max(out.width * std::fabs(view.eye_to_clip.m[0]), out.height * std::fabs(view.eye_to_clip.m[5]));
  out.metres_per_w = 1 / w_per_metre;
  return out;
}

Rect projected_rect(const Projector& p, const Box& box) noexcept {
  if (!holds(p.extent, box)) return kWholePlane;
  // One corner a lane, and no way out of the loop, for the compiler to do several at once.
  std::array<float, 8> x, y, w, widest;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3 at{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                  corner & 4 ? box.max.z : box.min.z};
    w[corner] = dot(p.rows[3], at);
    x[corner] = dot(p.rows[0], at) / w[corner];
    y[corner] = dot(p.rows[1], at) / w[corner];
    // |d(x/w)| <= (|dx| + |x/w|·|dw|) / |w - dw|
    const float error = 2 * p.coordinate_error / w[corner];
    widest[corner] = error * (1 + std::max(std::fabs(x[corner]), std::fabs(y[corner])));
  }
  if (!(std::ranges::min(w) > 2 * p.coordinate_error)) return kWholePlane;
  const float most = std::ranges::max(widest);
  // The second term covers the pixel mapping's own rounding and the rasteriser's 8-bit subpixel grid.
  const float slack_x = most * 0.5f * p.width + kSubpixelSlack,
              slack_y = most * 0.5f * p.height + kSubpixelSlack;
  return {(std::ranges::min(x) + 1) * 0.5f * p.width - slack_x,
          (1 - std::ranges::max(y)) * 0.5f * p.height - slack_y,
          (std::ranges::max(x) + 1) * 0.5f * p.width + slack_x,
          (1 - std::ranges::min(y)) * 0.5f * p.height + slack_y};
}

bool covers_sample(const Projector& p, const Rect& rect) noexcept {
  // A pixel centre is an integer plus one half.
  const auto holds = [](float low, float high, float limit) {
    low = std::max(low, 0.0f);
    high = std::min(high, limit);
    return std::floor(high + 0.5f) - 0.5f >= low && high >= 0.5f;
  };
  return holds(rect.min_x, rect.max_x, p.width) && holds(rect.min_y, rect.max_y, p.height);
}

float projected_area(const Projector& p, const Sphere& sphere) noexcept {
  float d = 1;
  if (!p.orthographic) {
    d = distance(p.eye, sphere.centre);
    if (d <= sphere.radius) return kInfinity;
  }
  const float radius = sphere.radius * p.pixels_per_metre / d;
  return std::numbers::pi_v<float> * radius * radius;
}

float projected_area_bound(const Projector& p, const Sphere& sphere) noexcept {
  if (p.orthographic) return projected_area(p, sphere);
  // A cone of half angle t, sin t = r/d, its axis at angle a off the view direction, cuts the image plane in
  // an ellipse of area pi·f²·sin²t·cos t / (cos(a+t)·cos(a-t))^(3/2).
  const float d = distance(p.eye, sphere.centre);
  if (d <= sphere.radius) return kInfinity;
  const float w = dot(p.rows[3], sphere.centre);  // depth along the view direction
  const float sine = sphere.radius / d, cosine = std::sqrt((d - sphere.radius) * (d + sphere.radius)) / d;
  const float cos_axis = std::min(w * p.metres_per_w / d, 1.0f);
  // cos(a+t)·cos(a-t) = cos²a - sin²t
  const float product = cos_axis * cos_axis - sine * sine;
  if (cos_axis <= 0 || product <= 0) return kInfinity;
  const float f = p.pixels_per_metre;
  return (1 + kAreaGrowth) * std::numbers::pi_v<float> * f * f * sine * sine * cosine /
         (product * std::sqrt(product));
}

}  // namespace sightline
