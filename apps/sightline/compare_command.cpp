// sightline compare: every method along a camera path, beside what it lost and kept in excess.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "command.hpp"
#include "device.hpp"
#include "page.hpp"
#include "workbench/camera/camera_path.hpp"
#include "workbench/measure/comparison_json.hpp"
#include "workbench/report/summary.hpp"

namespace sightline::app {

namespace {

struct CompareOptions {
  std::string scene, methods, path, size = "1280x720", pvs, json, report;
  std::optional<std::string> device;
  std::optional<std::size_t> frames;
  double moving = 0;
  bool limit = false, no_draw = false;
  RasterState faces = RasterState::materials;
};

std::unique_ptr<device::Device> device_of(const CompareOptions& options) {
  if (options.no_draw) return nullptr;
  return options.device ? open_device_or_cpu(*options.device) : open_device_if_any();
}

int run_compare(const CompareOptions& options) {
  expect_apart({{"SCENE", options.scene}, {"--pvs", options.pvs}, {"--path", options.path}},
               {{"--json", options.json}, {"--report", options.report}});
  measure::MeasureOptions measure;
  std::tie(measure.width, measure.height) = parse_size(options.size);
  measure.moving = options.moving;
  measure.limit = options.limit;
  const auto device = device_of(options);
  // Each turn on a device begins with a frame that does not count, too.
  if (device) measure.warm_up = 1, measure.repeats = 5, measure.finals = 10;
  Scene scene = load_scene(options.scene);
  set_raster_state(scene, options.faces);
  attach_pvs(scene, options.pvs);
  measure::Bench bench(scene,
                       options.methods.empty() ? measure::fitting_methods(scene, device != nullptr)
                                               : split("--methods", options.methods),
                       device.get());
  const std::string path_name =
      options.path.empty() ? std::string(camera::default_path(scene)) : options.path;
  const camera::CameraPath path = camera::make_path(scene, path_name, options.frames.value_or(0));
  const measure::Comparison comparison = measure::compare(bench, path, measure, progress("compare"));
  expect_silence(device.get());
  fmt::print("{}: {} objects, {} triangles; path '{}', {} views of {}{}; {}\n\n", printable(scene.name),
             scene.size(), triangle_count(scene), printable(path.name), path.cameras.size(), options.size,
             device ? " on " + comparison.device : "", report::sides_drawn(scene.raster_state));
  fmt::print("{}\n{}\n", report::render(report::summary_table(comparison)), report::verdict(comparison));
  if (const report::Table ratios = report::ratio_table(comparison); !ratios.rows.empty())
    fmt::print("\nWhere less than 20 % of the objects are visible:\n{}", report::render(ratios));
  if (!options.json.empty()) measure::write_json(options.json, comparison);
  if (!options.report.empty()) write_page(options.report, bench, comparison);
  return Exit::done;
}

}  // namespace

void add_compare(CLI::App& app, int& exit) {
  CLI::App& command =
      *app.add_subcommand("compare", "Run methods side by side along a camera path: the table");
  auto options = std::make_shared<CompareOptions>();
  command.add_option("SCENE", options->scene, kSceneHelp)->required();
  command.add_option("--pvs", options->pvs, "visible sets that bake wrote, for the method baked")
      ->check(not_empty())
      ->type_name("FILE");
  command
      .add_option("--methods", options->methods,
                  "methods, separated by commas (default: all that fit the scene)")
      ->check(not_empty())
      ->type_name("A,B");
  command
      .add_option("--path", options->path,
                  "near, far, rising, walk, or a JSON path file (default: walk in a level, else near)")
      ->check(not_empty())
      ->type_name("NAME|FILE");
  command
      .add_option("--frames", options->frames,
                  "views along the path; of a path file at most so many (default: 24, of a path file all)")
      ->transform(whole(1, 100000));
  command.add_option("--size", options->size, "image size in pixels")
      ->type_name("WxH")
      ->capture_default_str();
  CLI::Option* device = command
                            .add_option("--device", options->device,
                                        std::string(kDeviceHelp) + " (default: any where there is one)")
                            ->type_name("cpu|NAME");
  command.add_flag("--no-draw", options->no_draw, "cull on the CPU and draw nothing, as --device cpu does")
      ->excludes(device)
      ->disable_flag_override();
  add_faces(command, options->faces);
  command.add_option("--moving", options->moving, "share of the objects that move before every frame")
      ->check(number(0, 1));
  command
      .add_flag("--limit", options->limit,
                "also draw just what the item buffer sees, which no culling of whole objects can beat")
      ->disable_flag_override();
  command.add_option("--json", options->json, "also write one row a method and view as JSON to FILE")
      ->check(output_file())
      ->type_name("FILE");
  command.add_option("--report", options->report, "also write an HTML page with charts and pictures to DIR")
      ->check(page_folder())
      ->type_name("DIR");
  on_run(command, exit, [options] { return run_compare(*options); });
}

}  // namespace sightline::app
