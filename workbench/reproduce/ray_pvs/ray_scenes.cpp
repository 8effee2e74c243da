#include "workbench/reproduce/ray_pvs/ray_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/method.hpp>

#include "workbench/camera/random_views.hpp"
#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/loss.hpp"
#include "workbench/oracle/pixel_coverage.hpp"

namespace sightline::reproduce {

namespace {

std::string count(std::uint64_t number) {
  return report::format_count(static_cast<double>(number));
}

}  // namespace

RayScene measure_ray_scene(const Scene& scene, std::size_t views, const Progress& progress) {
  std::vector<Camera> cameras;
  for (const Viewpoint& from : scene.viewpoints) {
    if (cameras.size() == views) break;
    Camera camera;
    camera.eye = from.eye, camera.forward = from.forward;
    camera.near_plane = 0.1f, camera.far_plane = 1e5f;
    cameras.push_back(camera);
  }
  for (const Camera& camera : camera::random_cameras(scene, views - cameras.size(), 1))
    cameras.push_back(camera);

  const oracle::EmbreeJudge judge(scene);
  const auto guided = create_method(fmt::format("guided?target={}", kGuidedTarget), scene);
  const auto triangles = create_method(fmt::format("triangle-pvs?rays={}", kRaySceneSide), scene);
  RayScene out;
  out.scene = scene.name;
  Frame frame;
  for (const Camera& camera : cameras) {
    const View view = or_throw(make_view(camera, kRaySceneWidth, kRaySceneHeight));
    const oracle::ItemBuffer truth = judge.render(view);
    const auto start = std::chrono::steady_clock::now();
    cull(*guided, view, frame);
    out.guided_ms +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const std::uint64_t pixels = truth.ids.size(),
                        lost = oracle::compare_to_truth(truth, frame.visible).lost_pixels;
    const double share = static_cast<double>(lost) / static_cast<double>(pixels);
    out.guided_lost += lost;
    out.guided_rays += frame.stats.rays;
    out.guided_worst = std::max(out.guided_worst, share);
    out.guided_over += share > kGuidedTarget;
    out.pixels += pixels;

    cull(*triangles, view, frame);
    const oracle::Loss loss = oracle::compare_to_truth(truth, frame.visible);
    const auto covers =
        oracle::objects_that_cover(truth, kRaySceneWidth / kRaySceneSide, kRaySceneHeight / kRaySceneSide);
    out.triangle_lost += loss.lost.size();
    out.triangle_lost_pixels += loss.lost_pixels;
    for (const ObjectId object : loss.lost) {
      out.triangle_most = std::max<std::uint64_t>(out.triangle_most, truth.pixels[object]);
      out.triangle_covers += covers[object];
    }
    ++out.views;
    if (progress) progress(out.views, cameras.size());
  }
  return out;
}

report::Table guided_table(std::span<const RayScene> scenes) {
  report::Table table;
  table.header = {"scene", "views", "lost pixels", "worst view", "views over", "rays a view", "ms a view"};
  for (const RayScene& s : scenes) {
    const auto views = static_cast<double>(s.views);
    table.rows.push_back({s.scene, count(s.views), count(s.guided_lost),
                          fmt::format("{:.5f} %", 100 * s.guided_worst), count(s.guided_over),
                          report::format_count(std::round(static_cast<double>(s.guided_rays) / views)),
                          report::format_ms(s.guided_ms / views)});
  }
  return table;
}

report::Table triangle_pvs_table(std::span<const RayScene> scenes) {
  report::Table table;
  table.header = {"scene", "lost objects", "their pixels", "the largest", "with a whole 13x7 block"};
  for (const RayScene& s : scenes) {
    table.rows.push_back({s.scene, count(s.triangle_lost), count(s.triangle_lost_pixels),
                          count(s.triangle_most), count(s.triangle_covers)});
  }
  return table;
}

}  // namespace sightline::reproduce
