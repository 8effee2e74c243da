// sightline reproduce: a paper's tables, ours beside the published.
#include <fmt/format.h>

#include <memory>

#include "command.hpp"
#include "lab/reproduce/draw_calls.hpp"
#include "lab/reproduce/object_frustum.hpp"
#include "page.hpp"

namespace sightline::app {

namespace {

struct Options {
  bool quick = false;
  std::string report, device;
};

int run_object_frustum(const Options& options) {
  const Scene scene = lab::object_frustum_scene();
  const lab::EmbreeJudge judge(scene);
  const std::vector<lab::Contestant> contestants = lab::object_frustum_contestants(scene);
  const auto result =
      lab::reproduce_object_frustum(scene, judge, contestants, options.quick, progress("reproduce"));
  fmt::print(
      "Le Hoang Minh et al. 2022, table 2: {} trees on 1 km², eye at 8.9 m in the middle, ten runs\n\n{}\n",
      scene.size(), lab::render(result.runs));
  fmt::print("object-frustum tests only the objects of crossing cells: {:.1f} % of all.\n\n{}\n",
             100 * result.tested_share, lab::render(result.ratios));
  fmt::print("{}", lab::render(lab::summary_table(result.comparison)));
  if (!options.report.empty()) write_page(options.report, scene, judge, contestants, result.comparison);
  return Exit::done;
}

int run_draw_calls(const Options& options) {
  vulkan::DeviceOptions choice;
  choice.choice = options.device;
  vulkan::Device device(choice);
  const lab::DrawCallOptions how{.quick = options.quick};
  fmt::print("Serpa, Serpa & Rodrigues on {} ({})\n\n", device.info().name, device.info().driver);
  const lab::CallGrid grid = lab::measure_call_grid(device, how, progress("table 1"));
  fmt::print("Table 1: random triangles in draw calls, {}x{}\n\n{}\n", how.width, how.height,
             render(lab::table_of(grid)));
  fmt::print("On this device a draw call costs {:.2f} µs, a triangle {:.0f} ns.\n", grid.call_us,
             grid.triangle_ns);
  std::vector<lab::LevelWalk> walks;
  for (const lab::LevelChoice& level : lab::draw_call_levels()) {
    walks.push_back(lab::walk_level(device, level, how, progress(level.kind)));
    const lab::LevelWalk& walk = walks.back();
    fmt::print("\n{}: {}, {} triangles, {} views of {}x{}\n\n{}\n{}\n{}\n{}", walk.level, walk.kind,
               lab::format_count(static_cast<double>(walk.triangles)), walk.views, how.width, how.height,
               render(lab::heights_table(walk)), render(lab::methods_table(walk)),
               render(lab::submission_table(walk)), lab::findings(walk));
    std::fflush(stdout);
  }
  if (!options.report.empty()) lab::write_draw_call_report(options.report, device.info().name, grid, walks);
  return Exit::done;
}

}  // namespace

void add_reproduce(CLI::App& app, int& exit) {
  CLI::App& command =
      *app.add_subcommand("reproduce", "Print a paper's tables, ours beside the published, as ratios");
  command.require_subcommand(1);
  CLI::App& paper =
      *command.add_subcommand("object-frustum", "Le Hoang Minh et al. 2022: grid-cell and object-frustum");
  auto options = std::make_shared<Options>();
  paper.add_flag("--quick", options->quick, "fewer repeats");
  paper.add_option("--report", options->report, "also write an HTML page to DIR")->type_name("DIR");
  on_run(paper, exit, [options] { return run_object_frustum(*options); });

  CLI::App& calls = *command.add_subcommand(
      "draw-calls", "Serpa, Serpa & Rodrigues: triangles x draw calls, and walks through three game levels");
  calls.add_flag("--quick", options->quick, "fewer views and repeats");
  calls.add_option("--report", options->report, "also write an HTML page to DIR")->type_name("DIR");
  calls.add_option("--device", options->device, "Vulkan device: its number or part of its name")
      ->type_name("NAME");
  on_run(calls, exit, [options] { return run_draw_calls(*options); });
}

}  // namespace sightline::app
