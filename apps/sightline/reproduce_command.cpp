// sightline reproduce: a paper's tables, ours beside the published.
#include <fmt/format.h>

#include <memory>

#include "command.hpp"
#include "device.hpp"
#include "reproduce_object_frustum.hpp"
#include "reproduce_ray_pvs.hpp"
#include "workbench/report/summary.hpp"
#include "workbench/reproduce/draw_calls.hpp"
#include "workbench/reproduce/vertex_chunk.hpp"

namespace sightline::app {

namespace {

struct ReproduceOptions {
  bool quick = false;
  std::string report, device;
};

int run_vertex_chunk(const ReproduceOptions& options) {
  const auto device = open_device(options.device.empty() ? "any" : options.device);
  std::vector<reproduce::VertexChunkWorld> worlds;
  for (const char* name : {"regular", "irregular"}) {
    worlds.push_back(reproduce::reproduce_vertex_chunk(
        *device, name, {options.quick, !options.report.empty()}, progress(name)));
    const reproduce::VertexChunkWorld& world = worlds.back();
    fmt::print(
        "Lee & Shin 2023, world {}: {} objects, {}x{} on {}; each cell is ours (ratio to vertex-chunk / "
        "published ratio)\n\n",
        name, world.near.rows.front().stats.objects, world.near.width, world.near.height, world.near.device);
    for (const report::Table& table : world.tables) fmt::print("{}\n", report::render(table));
    fmt::print("Figure 7\n{}\n", report::render(world.rising_fps));
    for (const measure::Comparison* view : {&world.near, &world.far}) {
      fmt::print("{} view\n{}\n", view->path, report::render(report::summary_table(*view)));
    }
  }
  expect_silence(device.get());
  if (!options.report.empty()) reproduce::write_vertex_chunk_report(options.report, worlds);
  return Exit::done;
}

void add_ray_pvs(CLI::App& command, int& exit) {
  CLI::App& paper = *command.add_subcommand("ray-pvs", "Ye et al. 2023: toca, boca, iwcpa, bvha and saa");
  auto quick = std::make_shared<bool>(false);
  auto device = std::make_shared<std::string>("any"), report = std::make_shared<std::string>();
  paper.add_flag("--quick", *quick, "fewer repeats");
  paper.add_option("--device", *device, "the Vulkan device")->capture_default_str();
  paper.add_option("--report", *report, "also write an HTML page with figure 12's pictures to DIR")
      ->check(page_folder())
      ->type_name("DIR");
  on_run(paper, exit, [quick, device, report] { return run_ray_pvs(*quick, *device, *report); });
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

}  // namespace

void add_reproduce(CLI::App& app, int& exit) {
  CLI::App& command =
      *app.add_subcommand("reproduce", "Print a paper's tables, ours beside the published, as ratios");
  command.require_subcommand(1);
  add_object_frustum(command, exit);
  auto options = std::make_shared<ReproduceOptions>();
  CLI::App& chunks =
      *command.add_subcommand("vertex-chunk", "Lee & Shin 2023: vertex chunks and raster occlusion");
  chunks.add_flag("--quick", options->quick, "smaller pictures, fewer triangles, fewer repeats");
  chunks.add_option("--report", options->report, "also write an HTML page with charts and pictures to DIR")
      ->check(page_folder())
      ->type_name("DIR");
  chunks
      .add_option("--device", options->device, "a Vulkan device by index or part of its name (default: any)")
      ->check(not_empty())
      ->type_name("NAME");
  on_run(chunks, exit, [options] { return run_vertex_chunk(*options); });
  add_ray_pvs(command, exit);
  CLI::App& calls = *command.add_subcommand(
      "draw-calls", "Serpa, Serpa & Rodrigues: triangles x draw calls, and walks through three game levels");
  calls.add_flag("--quick", options->quick, "fewer views and repeats");
  calls.add_option("--report", options->report, "also write an HTML page to DIR")
      ->check(page_folder())
      ->type_name("DIR");
  calls.add_option("--device", options->device, "Vulkan device: its number or part of its name")
      ->check(not_empty())
      ->type_name("NAME");
  on_run(calls, exit, [options] { return run_draw_calls(*options); });
}

}  // namespace sightline::app
