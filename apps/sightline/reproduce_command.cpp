// sightline reproduce: a paper's tables, ours beside the published.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "device.hpp"
#include "workbench/device/renderer.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/measure/machine.hpp"
#include "workbench/report/page_folder.hpp"
#include "workbench/report/summary.hpp"
#include "workbench/reproduce/draw_calls/draw_calls.hpp"
#include "workbench/reproduce/object_frustum/object_frustum.hpp"
#include "workbench/reproduce/ray_pvs/ray_pvs.hpp"
#include "workbench/reproduce/vertex_chunk/vertex_chunk.hpp"

namespace sightline::app {

namespace {

struct ReproduceOptions {
  bool quick = false;
  std::string report, device, json;
};

// What a reproduction gives, as text and where it was asked for; pictures lie in the report's folder already.
void give(const reproduce::Reproduction& reproduction, const ReproduceOptions& options) {
  fmt::print("{}", reproduce::text(reproduction));
  if (!options.json.empty()) io::write_file(options.json, reproduce::json(reproduction));
  if (!options.report.empty()) reproduce::write_reproduction(options.report, reproduction);
}

int run_object_frustum(const ReproduceOptions& options) {
  const bool nothing_draws = options.device.empty() && device::list_devices().empty();
  const auto device = open_device_or_cpu(nothing_draws            ? "cpu"
                                         : options.device.empty() ? "any"
                                                                  : options.device);
  const reproduce::ObjectFrustumResult result = reproduce::measure_object_frustum(
      device.get(), {.quick = options.quick, .pictures = !options.report.empty()}, progress("reproduce"));
  expect_silence(device.get());
  if (!options.report.empty()) reproduce::write_object_frustum_pictures(options.report, result);
  give(reproduce::object_frustum_reproduction(result), options);
  return Exit::done;
}

int run_vertex_chunk(const ReproduceOptions& options) {
  const auto device = open_device(options.device.empty() ? "any" : options.device);
  std::vector<reproduce::VertexChunkWorld> worlds;
  for (const char* name : {"regular", "irregular"}) {
    worlds.push_back(reproduce::measure_vertex_chunk(*device, name, {options.quick, !options.report.empty()},
                                                     progress(name)));
    for (const auto& picture : worlds.back().pictures)
      device::save_png(picture.pixels, (std::filesystem::path(options.report) / picture.file).string());
  }
  expect_silence(device.get());
  give(reproduce::vertex_chunk_reproduction(worlds), options);
  return Exit::done;
}

int run_draw_calls(const ReproduceOptions& options) {
  const auto device = open_device(options.device.empty() ? "any" : options.device);
  const reproduce::DrawCallOptions how{.quick = options.quick};
  const measure::Machine machine = measure::this_machine();
  reproduce::DrawCallMeasurement measured;
  measured.machine = fmt::format("{} ({}), {}, {} hardware threads, {}x{}", device->info().name,
                                 device->info().driver, machine.cpu, machine.cores, how.width, how.height);
  measured.rates = reproduce::measure_call_rates(*device, how, progress("table 1"));
  for (const reproduce::LevelChoice& level : reproduce::kDrawCallLevels)
    measured.walks.push_back(reproduce::walk_level(*device, level, how, progress(level.kind)));
  expect_silence(device.get());
  if (!options.report.empty()) reproduce::write_level_pictures(options.report, measured);
  give(reproduce::draw_calls_reproduction(measured), options);
  return Exit::done;
}

int run_ray_pvs(const ReproduceOptions& options) {
  const auto device = open_device(options.device.empty() ? "any" : options.device);
  reproduce::RayPvsOptions how;
  how.quick = options.quick;
  how.pictures = options.report;
  const reproduce::RayPvs measured = reproduce::measure_ray_pvs(*device, how, progress("reproduce"));
  expect_silence(device.get());
  give(reproduce::ray_pvs_reproduction(measured), options);
  const bool alike = std::ranges::all_of(measured.models, [](const auto& model) { return model.identical; });
  return alike ? Exit::done : Exit::check_failed;
}

struct Paper {
  const char *name, *what, *quick;
  int (*run)(const ReproduceOptions&);
};
constexpr std::array kPapers{
    Paper{"object-frustum", "Le Hoang Minh et al. 2022: grid-cell and object-frustum", "fewer repeats",
          run_object_frustum},
    Paper{"vertex-chunk", "Lee & Shin 2023: vertex chunks and raster occlusion",
          "smaller pictures, fewer triangles, fewer repeats", run_vertex_chunk},
    Paper{"ray-pvs", "Ye et al. 2023: toca, boca, iwcpa, bvha and saa", "fewer repeats and views",
          run_ray_pvs},
    Paper{"draw-calls",
          "Serpa, Serpa & Rodrigues: triangles x draw calls, and walks through three game levels",
          "fewer views and repeats", run_draw_calls},
};

}  // namespace

void add_reproduce(CLI::App& app, int& exit) {
  CLI::App& command =
      *app.add_subcommand("reproduce", "Print a paper's tables, ours beside the published, and their ratios");
  command.require_subcommand(1);
  for (const Paper& paper : kPapers) {
    CLI::App& of_paper = *command.add_subcommand(paper.name, paper.what);
    auto options = std::make_shared<ReproduceOptions>();
    of_paper.add_flag("--quick", options->quick, paper.quick)->disable_flag_override();
    of_paper.add_option("--json", options->json, "also write every table as JSON to FILE")
        ->check(output_file())
        ->type_name("FILE");
    of_paper
        .add_option("--report", options->report, "also write an HTML page with charts and pictures to DIR")
        ->check(page_folder())
        ->type_name("DIR");
    of_paper
        .add_option("--device", options->device,
                    "a Vulkan device by index or part of its name (default: any)")
        ->check(not_empty())
        ->type_name("NAME");
    on_run(of_paper, exit, [options, run = paper.run] {
      expect_apart({}, {{"--json", options->json}, {"--report", options->report}});
      if (options->report.empty()) return run(*options);
      report::PageFolder folder(options->report);
      ReproduceOptions here = *options;
      here.report = folder.path().string();
      const int code = run(here);
      folder.commit();
      return code;
    });
  }
}

}  // namespace sightline::app
