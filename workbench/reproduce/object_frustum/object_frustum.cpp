#include "workbench/reproduce/object_frustum/object_frustum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/device/device.hpp"
#include "workbench/device/renderer.hpp"
#include "workbench/measure/bench.hpp"
#include "workbench/measure/machine.hpp"
#include "workbench/measure/timing.hpp"
#include "workbench/methods/object_frustum/grid_objects.hpp"
#include "workbench/methods/object_frustum/visible_list.hpp"
#include "workbench/methods/raster_occlusion/scene_occluders.hpp"
#include "workbench/reproduce/object_frustum/object_frustum_cells.hpp"
#include "workbench/reproduce/object_frustum/object_frustum_walks.hpp"

namespace sightline::reproduce {

namespace {

constexpr int kTableRuns = 10;
constexpr std::uint32_t kOpaqueTreesOnly = 1, kAllThatStandsHere = 7;

std::string with_cells(const char* method, const char* more = "") {
  return fmt::format("{}?{}{}", method, kObjectFrustumCells, more);
}

// The first two are table 2's, which draw objects one by one, as the paper's frame does.
std::vector<std::string> measured_forms() {
  return {with_cells("grid-cell", "&submission=objects"),
          with_cells("object-frustum", "&submission=objects"),
          with_cells("grid-cell"),
          with_cells("object-frustum"),
          with_cells("object-frustum", "&walk=printed"),
          "object-frustum?rows=6&columns=7&walk=printed",
          with_cells("object-frustum", fmt::format("&layers={}", kOpaqueTreesOnly).c_str()),
          with_cells("object-frustum", "&occlusion=masked")};
}
constexpr std::size_t kGridCell = 0, kObjectFrustum = 1;

Parameters parameters_of(const std::string& specification) {
  const MethodInfo& info = *find_method(specified_name(specification));
  return parse_parameters("method", specification, info.cpu.parameters);
}

template <class Work>
double median_time(int repeats, Work work) {
  std::vector<double> samples;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    samples.push_back(took.count());
  }
  return measure::timing_of(samples).median;
}

// On the CPU: what each form keeps and loses, and what deciding takes.
std::vector<ObjectFrustumForm> measure_forms(Scene& scene, const View& view, int repeats) {
  measure::Bench bench(scene, measured_forms());
  std::vector<ObjectFrustumForm> out;
  bench.run(bench.subjects()[kObjectFrustum], view);
  const std::vector<ObjectId> all = bench.subjects()[kObjectFrustum].frame.visible;
  for (measure::Subject& subject : bench.subjects()) {
    ObjectFrustumForm made;
    made.method = subject.name, made.guarantee = subject.method->guarantee();
    bench.run(subject, view);
    made.cull_ms = median_time(repeats, [&] { bench.run(subject, view); });
    const oracle::Judgement judged = bench.judge(subject, view);
    made.kept = subject.frame.visible.size(), made.tested = subject.frame.stats.tested;
    made.draw_calls = subject.frame.stats.draw_calls;
    made.missing = missing_of(all, subject.frame.visible);
    made.lost_objects = judged.loss.lost.size(), made.lost_pixels = judged.loss.lost_pixels;
    out.push_back(std::move(made));
  }
  return out;
}

// One form's frames, by turns whole ones and those that tell the GPU's own time: medians.
DrawnFrame drawn_frame(measure::Bench& bench, measure::Subject& subject, const View& view, int repeats) {
  std::vector<double> cpu, record, gpu;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const device::FrameTimes times = bench.run(subject, view);
    cpu.push_back(times.frame_ms), record.push_back(times.record_ms);
    const device::FrameTimes timed = bench.run(subject, view, device::Timed::passes);
    gpu.push_back(timed.gpu_ms(device::PassKind::cull) + timed.gpu_ms(device::PassKind::draw));
  }
  DrawnFrame drawn{measure::timing_of(cpu).median, measure::timing_of(record).median, {}};
  if (bench.renderer()->device().has_timestamps()) drawn.gpu = measure::timing_of(gpu).median;
  return drawn;
}

// The mean of table 2's frames of one method.
DrawnFrame mean_of(const std::vector<ObjectFrustumRun>& runs, DrawnFrame ObjectFrustumRun::*frame) {
  DrawnFrame mean;
  double gpu = 0;
  const auto count = static_cast<double>(runs.size());
  for (const ObjectFrustumRun& run : runs) {
    const DrawnFrame& drawn = run.*frame;
    mean.cpu += drawn.cpu / count, mean.record += drawn.record / count, gpu += drawn.gpu.value_or(0) / count;
  }
  if ((runs.front().*frame).gpu) mean.gpu = gpu;
  return mean;
}

void measure_drawn(measure::Bench& bench, const View& view, const ObjectFrustumOptions& options,
                   const Progress& progress, ObjectFrustumResult& out) {
  const auto subjects = bench.subjects();
  const int repeats = options.quick ? 3 : 9;
  for (std::size_t f = 0; f < subjects.size(); ++f) {
    bench.run(subjects[f], view);  // grows what grows
    out.forms[f].drawn = drawn_frame(bench, subjects[f], view, repeats);
  }
  for (int run = 0; run < kTableRuns; ++run) {
    ObjectFrustumRun made;
    // By turns first and second, so that drift of the machine hits both alike.
    for (int turn = 0; turn < 2; ++turn) {
      const bool grid = (run + turn) % 2 == 0;
      (grid ? made.grid_cell : made.object_frustum) =
          drawn_frame(bench, subjects[grid ? kGridCell : kObjectFrustum], view, repeats);
    }
    out.runs.push_back(std::move(made));
    if (progress) progress(static_cast<std::size_t>(run) + 1, kTableRuns);
  }
  out.forms[kGridCell].drawn = mean_of(out.runs, &ObjectFrustumRun::grid_cell);
  out.forms[kObjectFrustum].drawn = mean_of(out.runs, &ObjectFrustumRun::object_frustum);
}

// Steps of the life of a frame that the CPU takes before it draws.
struct ListTimes {
  double cells = 0, layers = 0, occlusion = 0, order = 0, comparison = 0;
  std::size_t changed = 0;  ///< elements of the list from the first on that is not the last frame's
};

// Steps C1 to C5 one by one; of the cells, all of them or object by object.
ListTimes time_list(const Scene& scene, const View& view, bool take_cells, int repeats) {
  const Parameters parameters = parameters_of(
      with_cells("object-frustum", fmt::format("&submission=objects&layers={}", kAllThatStandsHere).c_str()));
  const methods::GridObjects objects(scene, parameters);
  methods::VisibleList list(scene, parameters);
  methods::SceneOccluders occluders(scene);
  std::vector<partition::ObjectGrid::Run> runs;
  Frame frame, last;
  std::size_t changed = 0;
  std::vector<double> cells, layers, occlusion, order, comparison;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    frame.clear(), runs.clear();
    cells.push_back(median_time(1, [&] {
      const Frustum frustum = make_frustum(view);
      if (take_cells) return objects.take_cells(frustum, frame);
      objects.grid.classify(frustum, runs);
      objects.test_cells(frustum, runs, frame);
    }));
    layers.push_back(median_time(1, [&] { list.keep_layers(frame); }));
    Frame unhidden = frame;
    occlusion.push_back(median_time(1, [&] {
      if (occluders.usable() && occluders.draw({view, {}}, unhidden.visible))
        unhidden.visible.resize(occluders.keep_unhidden(unhidden.visible));
    }));
    order.push_back(median_time(1, [&] { list.draw(view, frame); }));
    comparison.push_back(median_time(1, [&] {
      changed = frame.visible.size() - device::unchanged<ObjectId>(frame.visible, last.visible);
    }));
    last = frame;
  }
  const auto median = [](std::vector<double>& samples) { return measure::timing_of(samples).median; };
  return {median(cells), median(layers), median(occlusion), median(order), median(comparison), changed};
}

std::vector<FrameStep> measure_steps(const Scene& scene, const View& view, const ObjectFrustumResult& result,
                                     int repeats) {
  const ObjectFrustumForm &grid = result.forms[kGridCell], &fine = result.forms[kObjectFrustum];
  const ListTimes of_grid = time_list(scene, view, true, repeats),
                  of_fine = time_list(scene, view, false, repeats);
  const auto both = [&](auto of) { return BothMethods{of(grid, of_grid), of(fine, of_fine)}; };
  using Form = ObjectFrustumForm;
  std::vector<FrameStep> steps{
      {"C1", "cells against the frustum; the crossing cells' objects",
       both([](const Form&, const ListTimes& t) { return t.cells; })},
      {"C2", "layers", both([](const Form&, const ListTimes& t) { return t.layers; })},
      {"C3", "occlusion (not in table 2)", both([](const Form&, const ListTimes& t) { return t.occlusion; })},
      {"C4", "order: front to back, back to front",
       both([](const Form&, const ListTimes& t) { return t.order; })},
      {"C5",
       fmt::format("comparison with the last frame's list: {} and {} are other", of_grid.changed,
                   of_fine.changed),
       both([](const Form&, const ListTimes& t) { return t.comparison; })}};
  if (!fine.drawn) return steps;
  steps.push_back({"C6", "what has changed to the GPU (in C7)", {}});
  steps.push_back({"C7", "a draw an object", both([](const Form& f, const ListTimes&) {
                     return std::max(0.0, f.drawn->record - f.cull_ms);
                   })});
  steps.push_back({"G1", "takes the commands (in G4)", {}});
  steps.push_back({"G2", "takes the lists (in G3)", {}});
  if (!fine.drawn->gpu) return steps;
  steps.push_back(
      {"G3", "draws object by object", both([](const Form& f, const ListTimes&) { return *f.drawn->gpu; })});
  steps.push_back({"G4", "the picture; the CPU has waited for G1 to G4",
                   both([](const Form& f, const ListTimes&) { return f.drawn->cpu - f.drawn->record; })});
  return steps;
}

// Figure 7: the cells of table 2's view, and the objects that a method keeps.
FigureFile cells_picture(const Scene& scene, const View& view, const ObjectFrustumOptions& options,
                         const std::string& method, std::string name) {
  const methods::GridObjects objects(scene, parameters_of(method));
  std::vector<partition::ObjectGrid::Run> runs;
  objects.grid.classify(make_frustum(view), runs);
  std::vector<DrawnCell> cells;
  for (std::uint32_t row = 0; row < objects.grid.rows(); ++row) {
    for (std::uint32_t column = 0; column < objects.grid.columns(); ++column) {
      auto kind = DrawnCell::Kind::outside;
      for (const auto& run : runs) {
        if (run.row != row || column < run.first_column || column >= run.last_column) continue;
        kind = run.overlap == Overlap::inside ? DrawnCell::Kind::inside : DrawnCell::Kind::crossing;
      }
      cells.push_back({objects.grid.cell_ground(row, column), cell_number(objects.grid, row, column), kind});
    }
  }
  Frame frame;
  cull(*create_method(method, scene), view, frame);
  std::vector<std::uint8_t> is_kept(scene.size(), 0);
  for (const ObjectId object : frame.visible) is_kept[object] = 1;
  std::vector<Box> kept, dropped;
  for (ObjectId object = 0; object < scene.size(); ++object)
    (is_kept[object] ? kept : dropped).push_back(scene.bounds[object]);
  const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
  return {std::move(name), draw_cells(cells, object_frustum_camera(scene), aspect, kept, dropped, 640), {}};
}

}  // namespace

Scene object_frustum_scene() {
  // A seed by which no tree stands right before the eye and fills the picture.
  return generate_world("forest?trees=30000&size=1000&ground=64&seed=209");
}

Camera object_frustum_camera_without_limit(const Scene& scene) {
  Camera camera;
  camera.eye = scene.viewpoints.front().eye;
  return camera;
}

Camera object_frustum_camera(const Scene& scene) {
  Camera camera = object_frustum_camera_without_limit(scene);
  camera.far_plane = kSightLimit;
  return camera;
}

std::vector<CellSize> sweep_cell_sizes(const Scene& scene, std::uint32_t width, std::uint32_t height) {
  const View limited = or_throw(make_view(object_frustum_camera(scene), width, height)),
             whole = or_throw(make_view(object_frustum_camera_without_limit(scene), width, height));
  std::vector<CellSize> out;
  const auto measure = [&](std::uint32_t rows, std::uint32_t columns) {
    CellSize size{rows, columns, 0, {}, {}};
    const std::string cells = fmt::format("?rows={}&columns={}", rows, columns);
    const Box cell = methods::GridObjects(scene, parameters_of("grid-cell" + cells)).grid.cell_ground(0, 0);
    size.metres = std::max(cell.max.x - cell.min.x, cell.max.z - cell.min.z);
    Frame frame;
    const auto kept = [&](const char* name) {
      const auto method = create_method(name + cells, scene);
      cull(*method, whole, frame);
      const double in_whole = static_cast<double>(frame.visible.size());
      cull(*method, limited, frame);
      return std::pair{in_whole, static_cast<double>(frame.visible.size())};
    };
    std::tie(size.whole.grid_cell, size.limited.grid_cell) = kept("grid-cell");
    std::tie(size.whole.object_frustum, size.limited.object_frustum) = kept("object-frustum");
    out.push_back(size);
  };
  for (const std::uint32_t across : {22u, 16u, 12u, 10u, 8u, 7u, 6u, 5u, 4u}) measure(across, across);
  measure(6, 7);
  measure(4, 5);
  return out;
}

ObjectFrustumResult measure_object_frustum(device::Device* device, const ObjectFrustumOptions& options,
                                           const Progress& progress) {
  ObjectFrustumResult out;
  Scene scene = object_frustum_scene();
  const measure::Machine machine = measure::this_machine();
  out.machine =
      fmt::format("{}, {} threads; {}; {} trees on their ground, {} triangles, {}x{} pixels", machine.cpu,
                  machine.cores, device ? device->info().name + " draws" : "nothing was drawn",
                  scene.size() - 1, triangle_count(scene), options.width, options.height);
  out.drawn_by_cpu = device && device->info().kind == "CPU";
  const View view = or_throw(make_view(object_frustum_camera(scene), options.width, options.height));
  const int repeats = options.quick ? 11 : 101;
  out.forms = measure_forms(scene, view, repeats);
  if (device) {
    measure::Bench bench(scene, measured_forms(), device);
    measure_drawn(bench, view, options, progress, out);
    if (options.pictures) {
      for (const auto& [subject, name] :
           {std::pair{kGridCell, "frame-grid-cell.png"}, {kObjectFrustum, "frame-object-frustum.png"}}) {
        bench.run(bench.subjects()[subject], view);
        out.files.push_back({name, "", bench.renderer()->picture()});
      }
    }
  }
  out.steps = measure_steps(scene, view, out, repeats);
  out.walk_losses = measure_walk_losses(scene, options.width, options.height);
  out.cell_sizes = sweep_cell_sizes(scene, options.width, options.height);
  out.figure_4 = walk_figure_4(), out.figure_6 = walk_figure_6();
  if (options.pictures) {
    out.files.push_back(
        cells_picture(scene, view, options, with_cells("grid-cell"), "figure-7-grid-cell.svg"));
    out.files.push_back(
        cells_picture(scene, view, options, with_cells("object-frustum"), "figure-7-object-frustum.svg"));
  }
  return out;
}

}  // namespace sightline::reproduce
