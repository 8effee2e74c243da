#include "workbench/reproduce/ray_pvs/ray_views.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/submission/draw_list.hpp"

namespace sightline::reproduce {

namespace {
constexpr float kFov = 0.8f;
}

Scene ray_model(int number, const RayPvsOptions& options) {
  return generate_world(fmt::format("strata?model={}&triangles={}", number, options.triangles));
}

View view_of_model(const Vec3& eye, const RayPvsOptions& options) {
  return or_throw(make_view({.eye = eye,
                             .forward = {-eye.x, -eye.y, -eye.z},
                             .vertical_fov = kFov,
                             .near_plane = 10,
                             .far_plane = 1e5f},
                            options.width, options.height));
}

Vec3 eye_around(const Scene& scene, double aside, double above) {
  const Vec3 v = scene.viewpoints.back().eye;
  const double radius = std::hypot(v.x, v.y, v.z), degree = std::numbers::pi / 180;
  const double around = std::atan2(double{v.z}, double{v.x}) + aside * degree, up = above * degree;
  return {static_cast<float>(radius * std::cos(up) * std::cos(around)),
          static_cast<float>(radius * std::sin(up)),
          static_cast<float>(radius * std::cos(up) * std::sin(around))};
}

double draw_frame(device::Renderer& renderer, const View& view, Frame& frame) {
  submission::DrawList(renderer.scene()).build(renderer.scene(), view, frame);
  return renderer
      .frame(view,
             [&](device::Recorder& recorder) {
               const auto pass = recorder.pass("draw", device::PassKind::draw);
               renderer.draw(recorder, frame.visible, frame.draws);
             })
      .frame_ms;
}

}  // namespace sightline::reproduce
