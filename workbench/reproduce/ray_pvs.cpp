#include "workbench/reproduce/ray_pvs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/device/renderer.hpp"
#include "workbench/methods/ray_pvs/device_rays.hpp"
#include "workbench/methods/ray_pvs/nearest_box.hpp"
#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/loss.hpp"

namespace sightline::reproduce {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

Scene model_scene(int number) {
  return generate_world("strata?model=" + std::to_string(number));
}

View view_of(const Scene& scene, float fov, const RayPvsOptions& options, const Vec3& forward) {
  const Viewpoint& from = scene.viewpoints.back();  // far
  return or_throw(make_view(
      {.eye = from.eye, .forward = forward, .vertical_fov = fov, .near_plane = 10, .far_plane = 1e5f},
      options.width, options.height));
}

// The model fills the picture from far outside.
constexpr float kFov = 0.8f;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Samples {
  std::vector<double> cpu, upload, compute, read_back;

  [[nodiscard]] RayTiming medians(double build) {
    return {build, median(cpu), median(upload), median(compute), median(read_back)};
  }
};

bool same_hits(const rays::RayHits& a, const rays::RayHits& b) {
  return a.object == b.object && a.distance == b.distance;
}

void draw(device::Renderer& renderer, Method& method, const View& view, double* ms) {
  Frame frame;
  cull(method, view, frame);
  const device::FrameTimes times = renderer.frame(view, [&](device::Recorder& recorder) {
    const auto pass = recorder.pass("draw", device::PassKind::draw);
    renderer.draw(recorder, frame.visible, frame.draws);
  });
  if (ms) *ms = times.frame_ms;
}

void draw_pictures(const Scene& scene, device::Device& device, const View& view, const std::string& stem) {
  device::Renderer renderer(device, scene);
  const auto all = create_method("none", scene), pvs = create_method("boca", scene);
  draw(renderer, *all, view, nullptr);
  const device::Picture everything = renderer.picture();
  draw(renderer, *pvs, view, nullptr);
  const device::Picture alone = renderer.picture();
  device::Picture difference = everything;
  for (std::size_t i = 0; i < difference.pixels.size(); ++i) {
    // What is the same fades; what differs is red.
    const std::uint32_t p = everything.pixels[i];
    const std::uint32_t grey = ((p & 0xff) + (p >> 8 & 0xff) + (p >> 16 & 0xff)) / 6 + 64;
    difference.pixels[i] = p == alone.pixels[i] ? 0xff000000u | grey * 0x010101u : 0xff0000ffu;
  }
  device::save_png(everything, stem + "-everything.png");
  device::save_png(alone, stem + "-pvs.png");
  device::save_png(difference, stem + "-difference.png");
}

void judge_model(const Scene& scene, const View& view, const rays::RayHits& hits, RayPvsModel& out) {
  const oracle::EmbreeJudge judge(scene);
  const oracle::ItemBuffer truth = judge.render(view);
  std::vector<std::uint8_t> seen;
  std::vector<ObjectId> visible;
  collect_visible(hits, scene.size(), seen, visible);
  const oracle::Loss loss = oracle::compare_to_truth(truth, visible);
  out.visible = truth.visible_count();
  out.kept = visible.size();
  out.lost_objects = loss.lost.size();
  out.lost_pixels = loss.lost_pixels;
  for (const std::uint32_t pixels : truth.pixels) out.object_pixels += pixels;
  const auto guided = create_method("guided", scene);
  Frame frame;
  cull(*guided, view, frame);
  const auto start = Clock::now();
  cull(*guided, view, frame);
  out.guided_ms = ms_since(start);
  out.guided_lost_pixels = oracle::compare_to_truth(truth, frame.visible).lost_pixels;
  out.guided_rays = frame.stats.rays;
}

}  // namespace

RayPvsModel measure_ray_model(int number, device::Device& device, const RayPvsOptions& options) {
  RayPvsModel out;
  out.model = number;
  const Scene scene = model_scene(number);
  out.meshes = scene.size();
  out.triangles = triangle_count(scene);
  const View view = view_of(scene, kFov, options, scene.viewpoints.back().forward);
  rays::RayGrid grid;
  grid.make(view, options.rays, options.rays);

  std::array<double, 5> build{};
  auto start = Clock::now();
  rays::Bvh bvh;
  bvh.build(scene.bounds);
  build[1] = ms_since(start);
  std::array<std::unique_ptr<methods::DeviceRays>, 3> device_rays;
  const std::array makers{methods::make_iwcpa, methods::make_bvha, methods::make_saa};
  for (std::size_t i = 0; i < makers.size(); ++i) {
    start = Clock::now();
    device_rays[i] = makers[i](device, scene);
    build[2 + i] = ms_since(start);
  }

  std::array<rays::RayHits, 5> hits;
  std::array<Samples, 5> samples;
  for (std::size_t round = 0; round <= options.repeats; ++round) {
    for (std::size_t turn = 0; turn < 5; ++turn) {
      const std::size_t m = (round + turn) % 5;
      methods::DeviceRayTimes times;
      if (m < 2) {
        start = Clock::now();
        if (m == 0) {
          methods::cast_at_all_boxes(scene.bounds, grid.prepared, hits[m]);
        } else {
          methods::cast_down_bvh(bvh, grid.prepared, hits[m]);
        }
        times.cpu = ms_since(start);
      } else {
        device_rays[m - 2]->cast(grid, hits[m], &times);
      }
      if (round == 0) continue;  // warm-up: pipelines compile on their first use
      samples[m].cpu.push_back(times.cpu);
      samples[m].upload.push_back(times.upload);
      samples[m].compute.push_back(times.compute);
      samples[m].read_back.push_back(times.read_back);
    }
  }
  for (std::size_t m = 0; m < 5; ++m) {
    out.timing[m] = samples[m].medians(build[m]);
    out.identical = out.identical && same_hits(hits[m], hits[0]);
  }
  judge_model(scene, view, hits[1], out);
  if (!options.pictures.empty()) {
    std::filesystem::create_directories(options.pictures);
    draw_pictures(scene, device, view, options.pictures + "/model-" + std::to_string(number));
  }
  return out;
}

std::vector<RegionTime> measure_regions(int number, device::Device& device, const RayPvsOptions& options) {
  const Scene scene = model_scene(number);
  device::Renderer renderer(device, scene);
  const auto all = create_method("none", scene), boca = create_method("boca", scene);
  const View whole = view_of(scene, kFov, options, scene.viewpoints.back().forward);
  const rays::ViewRays rays(whole);
  std::vector<RegionTime> out;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      RegionTime region{row, column};
      const Ray through = rays.through((column + 0.5) * options.width / 3, (row + 0.5) * options.height / 3);
      const View view = view_of(scene, kFov / 3, options, through.direction);
      std::vector<double> everything, pvs;
      for (std::size_t round = 0; round <= std::max<std::size_t>(2, options.repeats / 2); ++round) {
        double a = 0, b = 0;
        draw(renderer, *all, view, &a);
        draw(renderer, *boca, view, &b);
        if (round > 0) everything.push_back(a), pvs.push_back(b);
      }
      Frame frame;
      cull(*boca, view, frame);
      region.kept = frame.visible.size();
      region.everything_ms = median(everything);
      region.pvs_ms = median(pvs);
      out.push_back(region);
    }
  }
  return out;
}

report::Table ray_table(const std::vector<RayPvsModel>& models) {
  report::Table table;
  table.header = {"model", "meshes", "triangles"};
  for (const char* method : kRayMethods) table.header.push_back(fmt::format("{} ms", method));
  for (const char* method : kRayMethods) {
    if (std::string_view(method) == "boca") continue;
    table.header.push_back(fmt::format("{}/boca", method));
    table.header.push_back("published");
  }
  for (const RayPvsModel& model : models) {
    const auto column = static_cast<std::size_t>(model.model - 1);
    std::vector<std::string> row{std::to_string(model.model),
                                 report::format_count(static_cast<double>(model.meshes)),
                                 report::format_count(static_cast<double>(model.triangles))};
    for (const RayTiming& timing : model.timing) row.push_back(report::format_ms(timing.total()));
    for (std::size_t m = 0; m < 5; ++m) {
      if (m == 1) continue;
      row.push_back(report::format_ratio(model.timing[m].total(), model.timing[1].total(), 3));
      row.push_back(report::format_ratio(kPublishedRayMs[m][column], kPublishedRayMs[1][column], 3));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Table ray_parts_table(const std::vector<RayPvsModel>& models) {
  report::Table table;
  table.text_columns = 2;
  table.header = {"model", "method", "build ms", "CPU", "upload", "compute", "read-back"};
  for (const RayPvsModel& model : models) {
    for (std::size_t m = 0; m < 5; ++m) {
      const RayTiming& t = model.timing[m];
      table.rows.push_back({std::to_string(model.model), kRayMethods[m], report::format_ms(t.build),
                            report::format_ms(t.cpu), report::format_ms(t.upload),
                            report::format_ms(t.compute), report::format_ms(t.read_back)});
    }
  }
  return table;
}

report::Table ray_loss_table(const std::vector<RayPvsModel>& models) {
  report::Table table;
  table.header = {"model", "all five alike", "visible",      "in the PVS",  "lost objects", "lost pixels",
                  "share", "guided lost",    "guided share", "guided rays", "guided ms"};
  for (const RayPvsModel& m : models) {
    const double pixels = static_cast<double>(std::max<std::uint64_t>(1, m.object_pixels));
    table.rows.push_back({std::to_string(m.model), m.identical ? "yes" : "NO",
                          report::format_count(static_cast<double>(m.visible)),
                          report::format_count(static_cast<double>(m.kept)),
                          report::format_count(static_cast<double>(m.lost_objects)),
                          report::format_count(static_cast<double>(m.lost_pixels)),
                          fmt::format("{:.3f} %", 100 * static_cast<double>(m.lost_pixels) / pixels),
                          report::format_count(static_cast<double>(m.guided_lost_pixels)),
                          fmt::format("{:.4f} %", 100 * static_cast<double>(m.guided_lost_pixels) / pixels),
                          report::format_count(static_cast<double>(m.guided_rays)),
                          report::format_ms(m.guided_ms)});
  }
  return table;
}

report::Table region_table(const std::vector<RegionTime>& regions) {
  report::Table table;
  table.header = {"region", "kept", "everything ms", "PVS ms", "ratio"};
  for (const RegionTime& r : regions) {
    table.rows.push_back({fmt::format("row {}, column {}", r.row + 1, r.column + 1),
                          report::format_count(static_cast<double>(r.kept)),
                          report::format_ms(r.everything_ms), report::format_ms(r.pvs_ms),
                          report::format_ratio(r.everything_ms, r.pvs_ms, 3)});
  }
  return table;
}

}  // namespace sightline::reproduce
