// sightline reproduce: a paper's tables, ours beside the published.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "device.hpp"
#include "page.hpp"
#include "workbench/device/renderer.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/report/page_folder.hpp"
#include "workbench/report/summary.hpp"
#include "workbench/reproduce/draw_calls.hpp"
#include "workbench/reproduce/object_frustum.hpp"
#include "workbench/reproduce/ray_pvs.hpp"
#include "workbench/reproduce/vertex_chunk.hpp"

namespace sightline::app {

namespace {

struct ReproduceOptions {
  bool quick = false;
  std::string report, device, json;
};

// Frame times of both methods, drawn by a device.
void print_drawn_object_frustum(const std::string& name, bool quick) {
  const auto device = open_device(name);
  Scene scene = reproduce::object_frustum_scene();
  measure::Bench bench(scene, reproduce::kObjectFrustumMethods, device.get());
  measure::MeasureOptions measure;
  measure.repeats = quick ? 2 : 5;
  measure.warm_up = 1;
  const measure::Comparison drawn =
      measure::compare(bench, reproduce::object_frustum_path(scene), measure, progress("draw"));
  expect_silence(device.get());
  fmt::print("\nDrawn on {}, opaque front to back, then transparent back to front\n{}", drawn.device,
             report::render(report::summary_table(drawn)));
  const auto all = report::summarise(drawn);
  fmt::print("\nfps, object-frustum / grid-cell: {:.2f}, published {:.2f}\n", all[1].fps() / all[0].fps(),
             reproduce::kPublishedObjectFrustum.fps / reproduce::kPublishedGridCell.fps);
}

int run_object_frustum(const ReproduceOptions& options) {
  Scene scene = reproduce::object_frustum_scene();
  measure::Bench bench(scene, reproduce::kObjectFrustumMethods);
  const auto result = reproduce::reproduce_object_frustum(bench, options.quick, progress("reproduce"));
  fmt::print(
      "Le Hoang Minh et al. 2022, table 2: {} trees on 1 km², eye at 8.9 m in the middle, ten runs\n\n{}\n",
      scene.size(), report::render(result.runs));
  fmt::print("object-frustum tests only the objects of crossing cells: {:.1f} % of all.\n\n{}\n",
             100 * result.tested_share, report::render(result.ratios));
  fmt::print("{}", report::render(report::summary_table(result.comparison)));
  if (!options.report.empty()) write_page(options.report, bench, result.comparison);
  if (options.device.empty() && device::list_devices().empty()) {
    fmt::print("\nThere is no Vulkan device: nothing was drawn.\n");
  } else if (options.device != "cpu") {
    print_drawn_object_frustum(options.device.empty() ? "any" : options.device, options.quick);
  }
  return Exit::done;
}

// What a reproduction gives, as text and where it was asked for; pictures lie in the report's folder already.
void give(const reproduce::Reproduction& reproduction, const ReproduceOptions& options) {
  fmt::print("{}", reproduce::text(reproduction));
  if (!options.json.empty()) io::write_file(options.json, reproduce::json(reproduction));
  if (!options.report.empty()) reproduce::write_reproduction(options.report, reproduction);
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
  const auto opened = open_device(options.device.empty() ? "any" : options.device);
  device::Device& device = *opened;
  const reproduce::DrawCallOptions how{.quick = options.quick};
  fmt::print("Serpa, Serpa & Rodrigues on {} ({})\n\n", device.info().name, device.info().driver);
  const reproduce::CallGrid grid = reproduce::measure_call_grid(device, how, progress("table 1"));
  fmt::print("Table 1: random triangles in draw calls, {}x{}\n\n{}\n", how.width, how.height,
             render(reproduce::table_of(grid)));
  fmt::print("{}", reproduce::findings(grid));
  std::vector<reproduce::LevelWalk> walks;
  for (const reproduce::LevelChoice& level : reproduce::kDrawCallLevels) {
    walks.push_back(reproduce::walk_level(device, level, how, progress(level.kind)));
    const reproduce::LevelWalk& walk = walks.back();
    fmt::print("\n{}: {}, {} triangles, {} views of {}x{}\n\n{}\n{}\n{}\n{}\n{}", walk.level, walk.kind,
               report::format_count(static_cast<double>(walk.triangles)), walk.views, how.width, how.height,
               render(reproduce::heights_table(walk)), render(reproduce::calls_table(walk)),
               render(reproduce::methods_table(walk)), render(reproduce::submission_table(walk)),
               reproduce::findings(walk));
    std::fflush(stdout);
  }
  if (!options.report.empty())
    reproduce::write_draw_call_report(options.report, device.info().name, grid, walks);
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
    of_paper.add_flag("--quick", options->quick, paper.quick);
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
