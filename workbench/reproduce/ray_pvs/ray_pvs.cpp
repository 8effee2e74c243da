#include "workbench/reproduce/ray_pvs/ray_pvs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>
#include <sightline/workbench/method.hpp>

#include "workbench/measure/machine.hpp"
#include "workbench/measure/timing.hpp"
#include "workbench/measure/turns.hpp"
#include "workbench/methods/ray_pvs/break_time.hpp"
#include "workbench/methods/ray_pvs/device_rays.hpp"
#include "workbench/methods/ray_pvs/nearest_box.hpp"
#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/loss.hpp"
#include "workbench/reproduce/ray_pvs/ray_pictures.hpp"
#include "workbench/reproduce/ray_pvs/ray_views.hpp"

namespace sightline::reproduce {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double>& values) {
  return measure::timing_of(values).median;
}

std::size_t repeats_of(const RayPvsOptions& options) {
  return options.quick ? 2 : 5;
}

/// What a method holds between casts.
struct Contestant {
  rays::Bvh bvh;                              ///< boca's
  std::unique_ptr<methods::DeviceRays> rays;  ///< of those on the device

  Contestant() = default;
  Contestant(std::size_t method, const Boxes& boxes, device::Device& device, const Scene& scene) {
    if (method == kBoca) bvh.build(boxes);
    if (method == kIwcpa) rays = methods::make_iwcpa(device, scene);
    if (method == kTunedIwcpa) rays = methods::make_tuned_iwcpa(device, scene);
    if (method == kBvha) rays = methods::make_bvha(device, scene);
    if (method == kSaa) rays = methods::make_saa(device, scene);
  }

  methods::DeviceRayTimes cast(const Boxes& boxes, const rays::RayGrid& grid, rays::RayHits& hits) {
    methods::DeviceRayTimes times;
    if (rays) {
      rays->cast(grid, hits, &times);
      return times;
    }
    const auto start = Clock::now();
    if (bvh.empty()) {
      methods::cast_at_all_boxes(boxes, grid.prepared, hits);
    } else {
      methods::cast_down_bvh(bvh, grid.prepared, hits);
    }
    times.cpu = ms_since(start);
    return times;
  }
};

// What a program has before its first frame is triangles; their boxes are its own to find.
Boxes boxes_of_triangles(const Scene& scene) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Boxes boxes;
  boxes.resize(scene.size());
  for (ObjectId object = 0; object < scene.size(); ++object) {
    const Mesh& mesh = scene.meshes[scene.mesh[object]];
    Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (std::uint32_t i = 0; i < mesh.index_count; ++i) {
      const Vec3 p = transform_point(
          scene.transform[object], scene.positions[mesh.first_vertex + scene.indices[mesh.first_index + i]]);
      box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
      box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
    }
    boxes.set(object, box);
  }
  return boxes;
}

/// The methods by turns, so that what slows the machine down slows all of them.
class Race {
public:
  Race(const Scene& scene, device::Device& device, const View& view, std::uint32_t side)
      : scene_(scene), device_(device), renderer_(device, scene), view_(view) {
    grid_.make(view, side, side);
    for (std::size_t m = 0; m < kRayMethodCount; ++m)
      contestants_[m] = Contestant(m, scene.bounds, device, scene);
  }

  void run(std::size_t repeats, RayPvsModel& out) {
    draw_frame(renderer_, view_, frame_);
    for (Contestant& contestant : contestants_) contestant.cast(scene_.bounds, grid_, hits_[0]);
    measure::Turns turns(kRayMethodCount, 1);
    for (std::size_t round = 0; round < repeats; ++round) {
      for (const std::size_t m : turns.next()) {
        const methods::DeviceRayTimes ready = contestants_[m].cast(scene_.bounds, grid_, hits_[m]);
        const FirstTime first = first_set(m);
        const std::array times{ready.cpu,   ready.upload, ready.compute, ready.read_back,
                               first.boxes, first.made,   first.cast,    first.frame};
        for (std::size_t i = 0; i < times.size(); ++i) samples_[m][i].push_back(times[i]);
      }
    }
    for (std::size_t m = 0; m < kRayMethodCount; ++m) {
      std::array<double, kTimes> of{};
      for (std::size_t i = 0; i < kTimes; ++i) of[i] = median(samples_[m][i]);
      out.ready[m] = {of[0], of[1], of[2], of[3]};
      out.first[m] = {of[4], of[5], of[6], of[7]};
      out.identical =
          out.identical && hits_[m].object == hits_[0].object && hits_[m].distance == hits_[0].distance;
    }
  }

  [[nodiscard]] const rays::RayHits& hits() const noexcept { return hits_[kBoca]; }
  [[nodiscard]] device::Renderer& renderer() noexcept { return renderer_; }

private:
  static constexpr std::size_t kTimes = 8;

  FirstTime first_set(std::size_t method) {
    FirstTime time;
    auto start = Clock::now();
    const Boxes boxes = boxes_of_triangles(scene_);
    time.boxes = ms_since(start);
    start = Clock::now();
    Contestant contestant(method, boxes, device_, scene_);
    time.made = ms_since(start);
    start = Clock::now();
    contestant.cast(boxes, grid_, hits_[method]);
    collect_visible(hits_[method], scene_.size(), seen_, frame_.visible);
    time.cast = ms_since(start);
    start = Clock::now();
    draw_frame(renderer_, view_, frame_);
    time.frame = ms_since(start);
    return time;
  }

  const Scene& scene_;
  device::Device& device_;
  device::Renderer renderer_;
  View view_;
  rays::RayGrid grid_;
  std::array<Contestant, kRayMethodCount> contestants_;
  std::array<rays::RayHits, kRayMethodCount> hits_;
  std::array<std::array<std::vector<double>, kTimes>, kRayMethodCount> samples_;
  Frame frame_;
  std::vector<std::uint8_t> seen_;
};

void judge_model(const Scene& scene, const View& view, const oracle::ItemBuffer& truth,
                 std::span<const ObjectId> kept, RayPvsModel& out) {
  const oracle::Loss loss = oracle::compare_to_truth(truth, kept);
  out.visible = truth.visible_count();
  out.kept = kept.size();
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

/// The frames of a path, with what is visible in truth.
struct Path {
  std::vector<double> degrees;
  std::vector<View> views;
  std::vector<oracle::ItemBuffer> truths;
};

BreakTime look_up_along(const Path& path, const Scene& scene, double spacing, const RayPvsOptions& options) {
  methods::BreakTimeSets sets(scene, options.rays);
  BreakTime out;
  out.spacing = spacing;
  out.frames = path.views.size();
  auto start = Clock::now();
  for (double at = 0; at <= path.degrees.back(); at += spacing)
    sets.add(view_of_model(eye_around(scene, at, 0), options));
  out.idle_ms = ms_since(start);
  out.viewpoints = sets.size();
  out.bytes = sets.bytes();
  std::vector<double> cast, look_up;
  std::vector<ObjectId> visible;
  for (std::size_t i = 0; i < path.views.size(); ++i) {
    start = Clock::now();
    const std::span<const ObjectId> found = sets.look_up(path.views[i]);
    look_up.push_back(ms_since(start));
    start = Clock::now();
    sets.cast(path.views[i], visible);
    cast.push_back(ms_since(start));
    std::uint64_t pixels = 0;
    for (const std::uint32_t seen : path.truths[i].pixels) pixels += seen;
    out.pixels += pixels;
    out.look_up_lost_pixels += oracle::compare_to_truth(path.truths[i], found).lost_pixels;
    out.cast_lost_pixels += oracle::compare_to_truth(path.truths[i], visible).lost_pixels;
    std::uint64_t between = 0;
    for (const ObjectId object : visible) {
      if (!std::ranges::binary_search(found, object)) between += path.truths[i].pixels[object];
    }
    out.between_lost_pixels += between;
    if (pixels > 0)
      out.worst_share = std::max(out.worst_share, static_cast<double>(between) / static_cast<double>(pixels));
  }
  out.cast_ms = median(cast);
  out.look_up_ms = median(look_up);
  return out;
}

// The scenes that all methods are held equal on.
void measure_scenes(RayPvs& out, std::size_t views) {
  std::vector<std::string> names;
  for (int model = 1; model <= 5; ++model) names.push_back(fmt::format("world:strata?model={}", model));
  names.emplace_back("world:irregular");
  names.emplace_back("pak1-maps.pk3:maps/oa_dm1.bsp");
  for (const std::string& name : names) {
    Scene scene;
    try {
      scene = load_scene(name);
    } catch (const Error& error) {
      out.left_out.emplace_back(error.what());  // the levels are a package of their own
      continue;
    }
    out.scenes.push_back(measure_ray_scene(scene, views));
  }
}

}  // namespace

RayPvsModel measure_ray_model(int number, device::Device& device, const RayPvsOptions& options,
                              std::vector<RayPicture>& pictures) {
  RayPvsModel out;
  out.model = number;
  out.full = scene::count_strata(fmt::format("strata?model={}&full=yes", number));
  const Scene scene = ray_model(number, options);
  out.meshes = scene.size();
  out.triangles = triangle_count(scene);
  out.extent = extent(scene);
  const View view = view_of_model(scene.viewpoints.back().eye, options);
  Race race(scene, device, view, options.rays);
  race.run(repeats_of(options), out);
  std::vector<std::uint8_t> seen;
  std::vector<ObjectId> kept;
  collect_visible(race.hits(), scene.size(), seen, kept);
  const oracle::EmbreeJudge judge(scene);
  judge_model(scene, view, judge.render(view), kept, out);
  if (!options.pictures.empty())
    draw_model_pictures({race.renderer(), judge, options, number}, view, kept, pictures);
  return out;
}

std::vector<RayViewpoint> measure_ray_viewpoints(device::Device& device, const RayPvsOptions& options,
                                                 std::vector<RayPicture>& pictures) {
  constexpr int kModel = 4;
  const Scene scene = ray_model(kModel, options);
  device::Renderer renderer(device, scene);
  methods::BreakTimeSets boca(scene, options.rays);
  Frame everything, pvs;
  for (ObjectId object = 0; object < scene.size(); ++object) everything.visible.push_back(object);
  const double apart = options.quick ? 45 : 30;
  draw_frame(renderer, view_of_model(scene.viewpoints.back().eye, options), everything);
  std::vector<RayViewpoint> out;
  for (double above = 0; above < 80; above += options.quick ? 40 : 25) {
    for (double aside = 0; aside < 360; aside += apart) {
      RayViewpoint viewpoint{eye_around(scene, aside, above)};
      const View view = view_of_model(viewpoint.eye, options);
      boca.cast(view, pvs.visible);
      viewpoint.kept = pvs.visible.size();
      std::vector<double> all_ms, pvs_ms;
      for (std::size_t round = 0; round < (repeats_of(options) + 1) / 2; ++round) {
        all_ms.push_back(draw_frame(renderer, view, everything));
        pvs_ms.push_back(draw_frame(renderer, view, pvs));
      }
      viewpoint.everything_ms = median(all_ms);
      viewpoint.pvs_ms = median(pvs_ms);
      out.push_back(viewpoint);
    }
  }
  if (!options.pictures.empty()) draw_viewpoints_picture(renderer, out, options, pictures);
  return out;
}

std::vector<BreakTime> measure_break_time(const RayPvsOptions& options) {
  const Scene scene = ray_model(1, options);
  const oracle::EmbreeJudge judge(scene);
  Path path;
  for (double at = 0; at <= 90; at += options.quick ? 2.5 : 0.5) {
    path.degrees.push_back(at);
    path.views.push_back(view_of_model(eye_around(scene, at, 0), options));
    path.truths.push_back(judge.render(path.views.back()));
  }
  std::vector<BreakTime> out;
  for (const double spacing : {1.0, 5.0, 15.0, 45.0})
    out.push_back(look_up_along(path, scene, spacing, options));
  return out;
}

RayPvs measure_ray_pvs(device::Device& device, const RayPvsOptions& options, const Progress& progress) {
  constexpr std::size_t kSteps = 8;
  std::size_t done = 0;
  const auto step = [&] {
    if (progress) progress(++done, kSteps);
  };
  RayPvs out;
  const measure::Machine machine = measure::this_machine();
  out.machine = fmt::format("{} ({}) as the GPU, one thread of {} as the CPU; {} × {} pixels, medians of {}",
                            device.info().name, device.info().driver, machine.cpu, options.width,
                            options.height, repeats_of(options));
  out.device_kind = device.info().kind;
  for (int model = 1; model <= 5; ++model) {
    out.models.push_back(measure_ray_model(model, device, options, out.pictures));
    step();
  }
  out.viewpoints = measure_ray_viewpoints(device, options, out.pictures);
  step();
  out.break_time = measure_break_time(options);
  step();
  measure_scenes(out, options.quick ? 4 : 20);
  step();
  return out;
}

}  // namespace sightline::reproduce
