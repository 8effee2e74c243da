// sightline verify: random views against the item buffer.
#include <fmt/format.h>

#include <memory>
#include <utility>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "command.hpp"
#include "device.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/report/evidence_table.hpp"
#include "workbench/report/summary.hpp"
#include "workbench/report/verification_table.hpp"

namespace sightline::app {

namespace {

struct VerifyOptions {
  std::string scene, methods, size = "160x120", device = "cpu", pvs;
  std::size_t views = 100;
  std::uint64_t seed = 1;
  double moving = 0;
  RasterState faces = RasterState::materials;
};

// What the level's own visibility denies and rays see all the same, reason by reason.
void print_level_evidence(Scene scene, std::uint64_t seed) {
  set_raster_state(scene, RasterState::both_sides);  // walls are solid, whichever side is drawn
  constexpr std::size_t kEyes = 100;
  constexpr std::uint32_t kSide = 96;
  const oracle::EmbreeJudge judge(scene);
  fmt::print("\nThe level's own PVS against what rays see from open leaves:\n{}",
             report::render(
                 report::evidence_table(measure::gather_level_evidence(scene, judge, kEyes, kSide, seed))));
}

int run_verify(const VerifyOptions& options) {
  const auto [width, height] = parse_size(options.size);
  const auto device = open_device_or_cpu(options.device);
  Scene scene = load_scene(options.scene);
  set_raster_state(scene, options.faces);
  attach_pvs(scene, options.pvs);
  measure::Bench bench(scene,
                       options.methods.empty() ? measure::promising_methods(scene, device != nullptr)
                                               : split("--methods", options.methods),
                       device.get());
  const std::vector<Camera> cameras = camera::random_cameras(scene, options.views, options.seed);
  const measure::Verification result =
      measure::verify(bench, cameras, width, height, options.moving, progress("verify"));
  expect_silence(device.get());

  fmt::print("{}: {} random views of {}x{}, seed {}", scene.name, result.views, width, height, options.seed);
  if (device) fmt::print(", each as a camera cut and once more");
  if (options.moving > 0) fmt::print(", {:g} of the objects moving", options.moving);
  if (device) fmt::print(", on {}", result.device);
  fmt::print("; {}\n\n{}", report::sides_drawn(scene.raster_state),
             report::render(report::verification_table(result)));
  const char* separator = "\n";
  for (const measure::MethodVerdict& m : result.methods) {
    for (const measure::LostObject& lost : m.examples)
      fmt::print("{}{}\n", std::exchange(separator, ""), measure::describe(m, lost));
  }
  if (scene.level && !device) print_level_evidence(scene, options.seed);
  return result.passed() ? Exit::done : Exit::check_failed;
}

}  // namespace

void add_verify(CLI::App& app, int& exit) {
  CLI::App& command = *app.add_subcommand(
      "verify", "Prove methods against the item buffer on random views; exit 1 if a guarantee is broken");
  auto options = std::make_shared<VerifyOptions>();
  command.add_option("SCENE", options->scene, kSceneHelp)->required();
  command.add_option("--pvs", options->pvs, "visible sets that bake wrote, for the method baked")
      ->type_name("FILE");
  command
      .add_option("--methods", options->methods,
                  "methods, separated by commas (default: all that fit the scene and promise something; "
                  "on a Vulkan device, of those the ones that run on it)")
      ->type_name("A,B");
  command.add_option("--views", options->views, "random views")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command.add_option("--seed", options->seed, "of the random views")
      ->check(whole_number())
      ->capture_default_str();
  command.add_option("--size", options->size, "image size in pixels")
      ->type_name("WxH")
      ->capture_default_str();
  command.add_option("--device", options->device, kDeviceHelp)->type_name("cpu|NAME")->capture_default_str();
  add_faces(command, options->faces);
  command.add_option("--moving", options->moving, "share of the objects that move before every frame")
      ->check(share());
  on_run(command, exit, [options] { return run_verify(*options); });
}

}  // namespace sightline::app
