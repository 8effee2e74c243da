// sightline reproduce object-frustum: Le Hoang Minh et al. 2022, table 2 and the figures.
#include "reproduce_object_frustum.hpp"

#include <fmt/format.h>

#include <memory>

#include "command.hpp"
#include "device.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/reproduce/object_frustum.hpp"

namespace sightline::app {

namespace {

struct Options {
  bool quick = false;
  std::string report, json, device;
};

int run(const Options& options) {
  const bool nothing_draws = options.device.empty() && device::list_devices().empty();
  const auto device = open_device_or_cpu(nothing_draws            ? "cpu"
                                         : options.device.empty() ? "any"
                                                                  : options.device);
  const reproduce::ObjectFrustumResult result = reproduce::measure_object_frustum(
      device.get(), {.quick = options.quick, .pictures = !options.report.empty()}, progress("reproduce"));
  expect_silence(device.get());
  const reproduce::Reproduction reproduction = reproduce::object_frustum_reproduction(result);
  fmt::print("{}", reproduce::text(reproduction));
  if (!options.json.empty()) io::write_file(options.json, reproduce::json(reproduction));
  if (!options.report.empty()) reproduce::write_object_frustum_page(options.report, result);
  return Exit::done;
}

}  // namespace

void add_object_frustum(CLI::App& reproduce, int& exit) {
  CLI::App& paper =
      *reproduce.add_subcommand("object-frustum", "Le Hoang Minh et al. 2022: grid-cell and object-frustum");
  auto options = std::make_shared<Options>();
  paper.add_flag("--quick", options->quick, "fewer repeats");
  paper.add_option("--json", options->json, "also write every figure to FILE")
      ->check(output_file())
      ->type_name("FILE");
  paper.add_option("--report", options->report, "also write an HTML page with pictures to DIR")
      ->check(page_folder())
      ->type_name("DIR");
  paper.add_option("--device", options->device, "where frames are drawn; cpu draws none (default: any)")
      ->check(not_empty())
      ->type_name("cpu|NAME");
  on_run(paper, exit, [options] { return run(*options); });
}

}  // namespace sightline::app
