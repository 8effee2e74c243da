#include "workbench/device/view_data.hpp"

#include <gtest/gtest.h>

#include <sightline/view.hpp>

namespace sightline {
namespace {

struct Clip {
  double x, y, z, w;
};

Clip clip_of(const Mat4& m, const Vec3& p) {
  const auto row = [&](std::size_t r) {
    return double{m.m[r]} * p.x + double{m.m[4 + r]} * p.y + double{m.m[8 + r]} * p.z + double{m.m[12 + r]};
  };
  return {row(0), row(1), row(2), row(3)};
}

Vec3 combined(const Vec3* of, float x, float y) {
  return {of[0].x + x * of[1].x + y * of[2].x, of[0].y + x * of[1].y + y * of[2].y,
          of[0].z + x * of[1].z + y * of[2].z};
}

// The points of a ray are all seen at its place on the image, and lie the farther away the greater t is.
void expect_rays(View view, const char* which) {
  const device::shared::ViewData data = device::view_data(view, {{-50, -50, -50}, {50, 50, 50}});
  for (const float x : {-0.9f, 0.0f, 0.4f}) {
    for (const float y : {-0.7f, 0.0f, 0.8f}) {
      const Vec3 from = combined(data.ray_origin, x, y), way = combined(data.ray_direction, x, y);
      double last = 0;
      for (const float t : {0.125f, 0.25f, 0.5f, 0.75f}) {
        const Vec3 at{from.x + t * way.x, from.y + t * way.y, from.z + t * way.z};
        const Clip clip = clip_of(data.world_to_clip, at);
        EXPECT_NEAR(clip.x / clip.w, x, 1e-4) << which;
        EXPECT_NEAR(clip.y / clip.w, y, 1e-4) << which;
        const Vec3 ahead = view_direction(view), eye = eye_position(view);
        const double depth =
            double{at.x - eye.x} * ahead.x + double{at.y - eye.y} * ahead.y + double{at.z - eye.z} * ahead.z;
        EXPECT_GT(depth, last) << which;
        last = depth;
      }
    }
  }
}

TEST(ViewData, RaysGoThroughTheirPixels) {
  Camera camera;
  camera.eye = {7, 3, -20};
  camera.forward = {0.4f, -0.3f, -1};
  for (const Depth depth : {Depth::standard, Depth::reversed}) {
    camera.depth = depth;
    camera.orthographic_height = 0;
    expect_rays(*make_view(camera, 320, 180), "perspective");
    View off_centre = *make_view(camera, 320, 180);
    off_centre.eye_to_clip.m[8] = 0.3f, off_centre.eye_to_clip.m[9] = -0.2f;
    expect_rays(off_centre, "off centre");
    camera.orthographic_height = 12;
    expect_rays(*make_view(camera, 320, 180), "orthographic");
  }
}

}  // namespace
}  // namespace sightline
