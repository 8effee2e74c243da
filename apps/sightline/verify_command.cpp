// sightline verify: random views against the item buffer.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <memory>
#include <utility>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "command.hpp"
#include "device.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/measure/replay.hpp"
#include "workbench/report/evidence_table.hpp"
#include "workbench/report/summary.hpp"
#include "workbench/report/verification_table.hpp"

namespace sightline::app {

namespace {

struct VerifyOptions {
  std::string scene, methods, size = "160x120", device = "cpu", pvs, replay, replays = ".";
  std::size_t views = 100;
  std::uint32_t samples = 0;
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

// The first view in which each method broke its guarantee, as a file of its own.
void write_replays(const measure::Verification& result, const VerifyOptions& options) {
  for (const measure::MethodVerdict& m : result.methods) {
    if (m.holds() || m.examples.empty()) continue;
    std::string name = fmt::format("loss-{}-{}.json", m.method, m.examples.front().view);
    std::ranges::replace_if(
        name, [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '.'; }, '-');
    const std::string file = (std::filesystem::path(options.replays) / name).string();
    try {
      measure::save_replay(file, {options.scene, options.pvs, m.method, options.device, options.faces,
                                  options.moving, options.samples, m.examples.front()});
      fmt::print("\nThis view again: sightline verify --replay {}\n", printable(file));
    } catch (const Error& error) {
      fmt::print(stderr, "sightline: {}\n", error.what());  // what was found counts all the same
    }
  }
}

int run_replay(const VerifyOptions& options) {
  Scene scene;
  const measure::Replay replay = measure::load_replay(options.replay, [&](const measure::Replay& found) {
    scene = load_scene(found.scene);
    set_raster_state(scene, found.raster_state);
    attach_pvs(scene, found.pvs);
    return scene.origin;
  });
  const auto device = open_device_or_cpu(replay.device);
  const std::array methods{replay.method};
  measure::Bench bench(scene, methods, device.get(), replay.samples);
  const measure::MethodVerdict now = measure::look_again(bench, replay);
  expect_silence(device.get());
  if (now.examples.empty() && now.holds()) {
    if (replay.lost.object == kNoObject)
      fmt::print("{} draws this view as it should; {} pixels were otherwise.\n", now.method,
                 replay.lost.pixels);
    else
      fmt::print("{} loses nothing in this view any more; object {} and {} pixels were lost.\n", now.method,
                 replay.lost.object, replay.lost.pixels);
    return Exit::done;
  }
  for (const measure::LostObject& lost : now.examples) fmt::print("{}\n", measure::describe(now, lost));
  if (now.different_pixels > 0) fmt::print("{}: {} pixels differ\n", now.method, now.different_pixels);
  return now.holds() ? Exit::done : Exit::check_failed;
}

int run_verify(const VerifyOptions& options) {
  if (!options.replay.empty()) return run_replay(options);
  if (options.scene.empty()) throw Error("verify: expected SCENE, or --replay FILE");
  const auto [width, height] = parse_size(options.size);
  const auto device = open_device_or_cpu(options.device);
  Scene scene = load_scene(options.scene);
  set_raster_state(scene, options.faces);
  attach_pvs(scene, options.pvs);
  measure::Bench bench(scene,
                       options.methods.empty() ? measure::promising_methods(scene, device != nullptr)
                                               : split("--methods", options.methods),
                       device.get(), options.samples);
  const std::vector<Camera> cameras = camera::random_cameras(scene, options.views, options.seed);
  const measure::Verification result =
      measure::verify(bench, cameras, width, height, options.moving, progress("verify"));
  expect_silence(device.get());

  fmt::print("{}: {} random views of {}x{}, seed {}", printable(scene.name), result.views, width, height,
             options.seed);
  if (device) fmt::print(", each as a camera cut and once more");
  if (options.moving > 0) fmt::print(", {:g} of the objects moving", options.moving);
  if (options.samples > 0) fmt::print(", {} random places of each pixel", options.samples);
  if (device) fmt::print(", on {}", result.device);
  fmt::print("; {}\n\n{}", report::sides_drawn(scene.raster_state),
             report::render(report::verification_table(result)));
  const char* separator = "\n";
  for (const measure::MethodVerdict& m : result.methods) {
    for (const measure::LostObject& lost : m.examples)
      fmt::print("{}{}\n", std::exchange(separator, ""), measure::describe(m, lost));
  }
  if (std::ranges::any_of(result.methods, &measure::MethodVerdict::of_centres))
    fmt::print(
        "\nOf centres alone: what they promise holds at pixel centres, not at other places of a pixel. Those "
        "that\ntake coverage=area promise all of the image with it, as masked?coverage=area.\n");
  write_replays(result, options);
  if (scene.level && !device) print_level_evidence(scene, options.seed);
  return result.passed() ? Exit::done : Exit::check_failed;
}

}  // namespace

void add_verify(CLI::App& app, int& exit) {
  CLI::App& command = *app.add_subcommand(
      "verify", "Prove methods against the item buffer on random views; exit 1 if a guarantee is broken");
  auto options = std::make_shared<VerifyOptions>();
  CLI::Option* scene = command.add_option("SCENE", options->scene, kSceneHelp);
  command
      .add_option("--replay", options->replay,
                  "look at one view again, which a verify that lost wrote to FILE")
      ->excludes(scene)
      ->check(not_empty())
      ->type_name("FILE");
  command
      .add_option("--replays", options->replays,
                  "where views in which a guarantee broke are written for --replay")
      ->check(output_folder())
      ->type_name("DIR")
      ->capture_default_str();
  command.add_option("--pvs", options->pvs, "visible sets that bake wrote, for the method baked")
      ->check(not_empty())
      ->type_name("FILE");
  command
      .add_option("--methods", options->methods,
                  "methods, separated by commas (default: all that fit the scene and promise something; "
                  "on a Vulkan device, of those the ones that run on it)")
      ->check(not_empty())
      ->type_name("A,B");
  command.add_option("--views", options->views, "random views")
      ->transform(whole(1, 1000000))
      ->capture_default_str();
  command.add_option("--seed", options->seed, "of the random views")
      ->transform(whole(0, kAnySeed))
      ->capture_default_str();
  command
      .add_option("--samples", options->samples,
                  "random places of each pixel that are judged in place of its centre; what methods lose "
                  "there that promise pixel centres alone, as masked without coverage=area, is no failure")
      ->transform(whole(1, 64))
      ->type_name("N");
  command.add_option("--size", options->size, "image size in pixels")
      ->type_name("WxH")
      ->capture_default_str();
  command.add_option("--device", options->device, kDeviceHelp)->type_name("cpu|NAME")->capture_default_str();
  add_faces(command, options->faces);
  command.add_option("--moving", options->moving, "share of the objects that move before every frame")
      ->check(number(0, 1));
  on_run(command, exit, [options] { return run_verify(*options); });
}

}  // namespace sightline::app
