// What C gives, as C++: views of boxes and spheres, cameras, threads.
#include <sightline/view.hpp>

#include <bit>
#include <cmath>

#include "bindings/c/calls.hpp"

namespace sightline::c_api {

namespace {

static_assert(sizeof(sightline_view) == sizeof(WorldView) &&
              offsetof(sightline_view, origin) == offsetof(WorldView, origin) &&
              offsetof(sightline_view, eye_to_clip) == offsetof(View, eye_to_clip) &&
              offsetof(sightline_view, width) == offsetof(View, width));

bool within_reach(const double point[3]) {  // false for NaN, too
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::fabs(point[axis]) <= kWorldReach)) return false;
  }
  return true;
}

Vec3 vector_of(const float v[3]) {
  return {v[0], v[1], v[2]};
}

bool side_by_side(const sightline_sphere_view& v) {
  return v.data[0] && v.data[1] == v.data[0] + 1 && v.data[2] == v.data[0] + 2;
}

Status copy_spheres(const sightline_sphere_view& v, std::vector<Sphere>& copied) {
  const auto number = [&](std::size_t k) { return Strided<const float>(v.data[k], v.count, v.stride); };
  const auto x = number(0), y = number(1), z = number(2), radius = number(3);
  if (!x.sound() || !y.sound() || !z.sound() || !radius.sound()) {
    return {StatusCode::bad_argument,
            "spheres: a pointer is NULL, the stride too short, or the count more than memory holds"};
  }
  copied.resize(v.count);
  for (std::size_t i = 0; i < v.count; ++i) copied[i] = {{x[i], y[i], z[i]}, radius[i]};
  return {};
}

}  // namespace

WorldView view_of(const sightline_view& view) noexcept {
  return std::bit_cast<WorldView>(view);
}
sightline_view view_of(const WorldView& view) noexcept {
  return std::bit_cast<sightline_view>(view);
}

Status take(const sightline_view& given, WorldView& view) noexcept {
  view = view_of(given);
  return check(view);
}

Status take(const sightline_box_view& given, BoxView& boxes) noexcept {
  sightline_box_view v{};
  if (!take_struct(&given, SIGHTLINE_FIRST_SIZE(sightline_box_view, origin), v)) {
    return {StatusCode::bad_argument,
            "boxes: a struct_size is unknown, expected one of sightline_boxes_of and its like"};
  }
  const WorldPoint origin{v.origin[0], v.origin[1], v.origin[2]};
  const auto floats = [&](int i) { return static_cast<const float*>(v.data[i]); };
  const auto doubles = [&](int i) { return static_cast<const double*>(v.data[i]); };
  switch (v.form) {
    case SIGHTLINE_MIN_MAX_FLOAT:
      boxes = BoxView::min_max(floats(0), floats(1), v.stride, v.count, origin);
      return {};
    case SIGHTLINE_MIN_MAX_DOUBLE:
      boxes = BoxView::min_max(doubles(0), doubles(1), v.stride, v.count);
      return {};
    case SIGHTLINE_CENTRE_HALF_FLOAT:
      boxes = BoxView::centre_half(floats(0), floats(1), v.stride, v.count, origin);
      return {};
    case SIGHTLINE_CENTRE_HALF_DOUBLE:
      boxes = BoxView::centre_half(doubles(0), doubles(1), v.stride, v.count);
      return {};
    case SIGHTLINE_ARRAYS_FLOAT:
      boxes =
          BoxView::arrays(floats(0), floats(1), floats(2), floats(3), floats(4), floats(5), v.count, origin);
      return {};
    default:
      return {StatusCode::bad_argument,
              "boxes: a form is unknown, expected SIGHTLINE_MIN_MAX_FLOAT or one "
              "of its like"};
  }
}

Status take(const sightline_sphere_view& given, GivenSpheres& spheres) noexcept {
  sightline_sphere_view v{};
  if (!take_struct(&given, SIGHTLINE_FIRST_SIZE(sightline_sphere_view, count), v) || v.arrays > 1) {
    return {StatusCode::bad_argument,
            "spheres: struct_size or arrays are unknown, expected those of "
            "sightline_spheres_of or sightline_spheres_arrays"};
  }
  SphereView& view = spheres;
  if (v.arrays == 1) {
    view = SphereView::arrays(v.data[0], v.data[1], v.data[2], v.data[3], v.count);
  } else if (side_by_side(v)) {
    view = SphereView(v.data[0], v.data[3], v.stride, v.count);
  } else {
    if (const Status ok = copy_spheres(v, spheres.copied); !ok) return ok;
    view = SphereView(spheres.copied);
  }
  return {};
}

Status take(const sightline_jobs& given, JobSystem& jobs) noexcept {
  if (given.threads > kMaxJobs || given.reserved != 0) {
    return {StatusCode::bad_argument, "jobs: expected at most 64 threads, and 0 where it is reserved"};
  }
  jobs = {given.run, given.user, given.threads == 0 ? 1 : given.threads};
  return {};
}

}  // namespace sightline::c_api

using namespace sightline;
using namespace sightline::c_api;

extern "C" {

sightline_status sightline_camera_view(const sightline_camera* camera, uint32_t width, uint32_t height,
                                       sightline_view* view) {
  if (!camera || !view) return refuse("sightline_camera_view: the camera or the view is NULL");
  sightline_camera c = sightline_camera_default();
  if (!take_struct(camera, SIGHTLINE_FIRST_SIZE(sightline_camera, shift), c) || c.reversed_depth > 1) {
    return refuse(
        "camera: struct_size or reversed_depth are unknown, expected those of "
        "sightline_camera_default");
  }
  if (!within_reach(c.eye) || !within_reach(c.origin)) {
    return keep({StatusCode::bad_view, "camera: expected the eye and the origin within 1e11 m of 0"});
  }
  Camera described;
  described.eye = {static_cast<float>(c.eye[0] - c.origin[0]), static_cast<float>(c.eye[1] - c.origin[1]),
                   static_cast<float>(c.eye[2] - c.origin[2])};
  described.forward = vector_of(c.forward), described.up = vector_of(c.up);
  described.vertical_fov = c.vertical_fov, described.orthographic_height = c.orthographic_height;
  described.near_plane = c.near_plane, described.far_plane = c.far_plane;
  described.shift_x = c.shift[0], described.shift_y = c.shift[1];
  described.depth = c.reversed_depth ? Depth::reversed : Depth::standard;
  const Result<View> made = make_view(described, width, height);
  if (!made) return keep(made.error());
  *view = view_of(WorldView{*made, {c.origin[0], c.origin[1], c.origin[2]}});
  return SIGHTLINE_OK;
}

sightline_status sightline_view_check(const sightline_view* view) {
  if (!view) return refuse("sightline_view_check: the view is NULL");
  return keep(check(view_of(*view)));
}

}  // extern "C"
