#include "library/occlusion/eye_projection.hpp"

#include <algorithm>
#include <cmath>

#include "library/geometry/error_bounds.hpp"

namespace sightline::occlusion {

using namespace geometry;

namespace {

Vec4 to_vec4(const glm::dvec3& v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

// The rows (pixel x, pixel y, w) of a projection about the eye, in double precision.
struct Rows {
  glm::dvec3 eye;  // in the view's own space
  glm::dvec3 x, y, w;
  glm::dvec3 constant;
  glm::dvec3 forward;  // unit
  bool orthographic = false;
};

Rows rows_of(const View& view, double scale) {
  const glm::dmat4 clip = to_double(view.eye_to_clip) * to_double(view.world_to_eye);
  const glm::dmat4 rows = glm::transpose(clip);
  Rows out;
  out.orthographic = is_orthographic(view);
  out.forward = glm::normalize(-glm::dvec3(glm::inverse(to_double(view.world_to_eye))[2]));
  const double half_width = 0.5 * view.width / scale, half_height = 0.5 * view.height / scale;
  const glm::dvec4 x = (rows[0] + rows[3]) * half_width, y = (rows[3] - rows[1]) * half_height, w = rows[3];
  out.x = glm::dvec3(x), out.y = glm::dvec3(y), out.w = glm::dvec3(w);
  if (out.orthographic) {
    out.eye = glm::dvec3(glm::inverse(to_double(view.world_to_eye))[3]);
  } else {
    // Where x, y and w are all 0.
    const glm::dmat3 matrix = glm::transpose(glm::dmat3(out.x, out.y, out.w));
    out.eye = -(glm::inverse(matrix) * glm::dvec3(x.w, y.w, w.w));
  }
  const auto at_eye = [&](const glm::dvec4& row) { return glm::dot(glm::dvec3(row), out.eye) + row.w; };
  out.constant = out.orthographic ? glm::dvec3(at_eye(x), at_eye(y), at_eye(w)) : glm::dvec3(0);
  return out;
}

// What the way there and back adds up to, by magnitudes, along the axis where it is most (Skeel 1979): 1 for
// what is moved. Scaling what is placed along its own axes does not change it. No number: there is no way
// back.
double skew_of(const glm::dmat3& there, const glm::dmat3& back) {
  glm::dvec3 sum(0);
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < 3; ++k) sum += glm::abs(there[k]) * std::fabs(back[c][k]);
  }
  const double all = sum.x + sum.y + sum.z;
  return std::isfinite(all) ? std::max({sum.x, sum.y, sum.z}) : all;
}

// How far before or behind the eye an orthographic view's near and far planes lie at most; no number where
// they lie nowhere.
float largest_depth(const View& view) {
  const double along = double{view.eye_to_clip.m[10]}, at = double{view.eye_to_clip.m[14]};
  return static_cast<float>(std::max(std::fabs(at / along), std::fabs((1 - at) / along)));
}

// Of rows about an eye. In line, so that nothing grows where nothing is placed.
[[gnu::always_inline]] inline EyeProjection about_eye(const Rows& rows, const glm::dvec3& eye) {
  EyeProjection out;
  const Split about = split(eye);
  out.eye_high = about.rounded, out.eye_low = about.rest;
  out.x = to_vec4(rows.x, rows.constant.x);
  out.y = to_vec4(rows.y, rows.constant.y);
  out.w = to_vec4(rows.w, rows.constant.z);
  out.nearness = to_vec4(-rows.forward, 0);
  out.orthographic = rows.orthographic;
  return out;
}

}  // namespace

EyeProjection eye_projection(const WorldView& view, const WorldPoint& origin, std::uint32_t scale) noexcept {
  const Rows rows = rows_of(view.view, scale);
  return about_eye(rows, rows.eye + glm::dvec3(view.origin.x - origin.x, view.origin.y - origin.y,
                                               view.origin.z - origin.z));
}

EyeProjection placed_projection(const View& view, const glm::dmat4& placement, std::uint32_t scale) noexcept {
  Rows rows = rows_of(view, scale);
  const glm::dmat3 turned = glm::transpose(glm::dmat3(placement));
  for (glm::dvec3* row : {&rows.x, &rows.y, &rows.w, &rows.forward}) *row = turned * *row;
  return about_eye(rows, glm::dvec3(glm::inverse(placement) * glm::dvec4(rows.eye, 1)));
}

float corner_rounding(const EyeProjection& e, const View& view, std::uint32_t scale) noexcept {
  const auto length = [](const Vec4& row) { return std::hypot(row.x, row.y, row.z); };
  if (!e.orthographic) return kCornerRounding * std::max(length(e.x), length(e.y)) / length(e.w);
  // An orthographic view has no focal length. What it sees lies about as far away as the image is wide, or as
  // its near and far planes are.
  const float size = static_cast<float>(view.width + view.height) / static_cast<float>(scale),
              depth = largest_depth(view) * std::max(length(e.x), length(e.y));
  return kCornerRounding * (depth > size ? depth : size);
}

PixelRays pixel_rays(const View& view, std::uint32_t pixel) noexcept {
  const Rows rows = rows_of(view, pixel);
  PixelRays out;
  const glm::dvec3 last = rows.orthographic ? rows.forward : rows.w;
  const glm::dmat3 inverse = glm::inverse(glm::transpose(glm::dmat3(rows.x, rows.y, last)));
  const double scale = rows.orthographic ? rows.constant.z : 1;
  const glm::dvec3 across = inverse[0] * scale, down = inverse[1] * scale;
  const glm::dvec3 at =
      rows.orthographic ? -(inverse[0] * rows.constant.x + inverse[1] * rows.constant.y) : inverse[2];
  for (int a = 0; a < 3; ++a) {
    out.at[a] = static_cast<float>(at[a]);
    out.across[a] = static_cast<float>(across[a]);
    out.down[a] = static_cast<float>(down[a]);
    out.forward[a] = static_cast<float>(rows.forward[a]);
  }
  out.edge_on = static_cast<float>(kEdgeOnSine);
  const double turn = glm::determinant(glm::dmat3(rows.x, rows.y, last));
  out.turns_right = turn * scale < 0;
  const glm::dvec4 front = geometry::near_plane(view);
  const glm::dvec3 normal(front);
  if (glm::length(normal) > 0.5) {
    const double at_eye = glm::dot(normal, rows.eye) + front.w;
    // A little behind the plane: what is cut off must not be drawn.
    // An orthographic image reaches sideways however near its plane is.
    const double sideways =
        rows.orthographic
            ? std::hypot(view.width / glm::length(rows.x), view.height / glm::length(rows.y)) / pixel
            : 0;
    const double safe = near_plane_slack(at_eye, glm::length(rows.eye)) + kNearSideways * sideways;
    out.near_plane = to_vec4(normal, at_eye - safe);
  } else {
    out.near_plane = to_vec4(rows.w, rows.constant.z - kLeastW);
  }
  return out;
}

double place(const ExactAffine& placement, EyeProjection& projection, PixelRays& rays) noexcept {
  const glm::dmat3& m = placement.linear;
  const glm::dmat3 inverse = glm::inverse(m), turned = glm::transpose(m);
  const double skew = skew_of(m, inverse);
  if (!(skew <= kMostSkew)) return 0;
  EyeProjection& e = projection;
  const glm::dvec3 eye = to_double(e.eye_high) + to_double(e.eye_low);
  const Split about = split(inverse * (eye - placement.translation));
  e.eye_high = about.rounded, e.eye_low = about.rest;
  for (Vec4* row : {&e.x, &e.y, &e.w, &e.nearness, &rays.near_plane})
    *row = to_vec4(turned * glm::dvec3(row->x, row->y, row->z), row->w);
  rays.edge_on *= static_cast<float>(glm::length(inverse * glm::make_vec3(rays.forward.data())));
  for (auto* direction : {&rays.at, &rays.across, &rays.down, &rays.forward}) {
    const glm::dvec3 its = inverse * glm::dvec3(glm::make_vec3(direction->data()));
    for (int a = 0; a < 3; ++a) (*direction)[static_cast<std::size_t>(a)] = static_cast<float>(its[a]);
  }
  double squares = 0;
  for (int c = 0; c < 3; ++c) squares += glm::dot(inverse[c], inverse[c]);
  rays.stretch = static_cast<float>(std::sqrt(squares / 3));
  rays.turns_right = rays.turns_right != (glm::determinant(m) < 0);
  return std::max(1.0, skew / kFreeSkew);
}

}  // namespace sightline::occlusion
