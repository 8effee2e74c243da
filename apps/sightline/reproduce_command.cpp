// sightline reproduce: a paper's tables, ours beside the published.
#include <fmt/format.h>

#include <memory>

#include "command.hpp"
#include "lab/reproduce/object_frustum.hpp"
#include "page.hpp"
#include "reproduce_ray_pvs.hpp"

namespace sightline::app {

namespace {

struct Options {
  bool quick = false;
  std::string report;
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

void add_ray_pvs(CLI::App& command, int& exit) {
  CLI::App& paper = *command.add_subcommand("ray-pvs", "Ye et al. 2023: toca, boca, iwcpa, bvha and saa");
  auto quick = std::make_shared<bool>(false);
  auto device = std::make_shared<std::string>("any"), report = std::make_shared<std::string>();
  paper.add_flag("--quick", *quick, "fewer repeats");
  paper.add_option("--device", *device, "the Vulkan device")->capture_default_str();
  paper.add_option("--report", *report, "also write figure 12's pictures to DIR")->type_name("DIR");
  on_run(paper, exit, [quick, device, report] { return run_ray_pvs(*quick, *device, *report); });
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
  add_ray_pvs(command, exit);
}

}  // namespace sightline::app
