// sightline casters: shadow caster culling against lit pictures.
#include <fmt/format.h>

#include <memory>
#include <tuple>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "command.hpp"
#include "device.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/measure/caster_proof.hpp"

namespace sightline::app {

namespace {

struct CastersCall {
  std::string scene, size = "160x120", light = "directional", device = "any", picture;
  std::size_t views = 100;
  measure::CasterOptions options;
  RasterState faces = RasterState::materials;
};

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

int run_casters(CastersCall& call) {
  expect_apart({{"SCENE", call.scene}}, {{"--picture", call.picture}});
  std::tie(call.options.width, call.options.height) = parse_size(call.size);
  call.options.light = call.light == "spot" ? LightKind::spot : LightKind::directional;
  const auto device = open_device(call.device);
  Scene scene = load_scene(call.scene);
  set_raster_state(scene, call.faces);
  device::Renderer renderer(*device, scene);
  const std::vector<Camera> cameras = camera::random_cameras(scene, call.views, call.options.seed);
  const measure::CasterEvidence found =
      measure::prove_casters(renderer, cameras, call.options, progress("casters"));
  expect_silence(device.get());
  if (found.views == 0) throw Error(call.scene + ": no view has a light whose map can be made");
  if (!call.picture.empty()) device::save_png(found.picture, call.picture);
  const measure::CasterOptions& o = call.options;
  const std::uint32_t texels = 2 * o.lookup.reach + 1;
  fmt::print(
      "{}: {} random views of {}x{} up to {:g} m, seed {}, each with a {} light of its own and a map "
      "of {}x{};\neach point asks {}x{} texels, {:g} m off; on {}\n\n",
      printable(scene.name), found.views, o.width, o.height, o.distance, o.seed, call.light, o.map, o.map,
      texels, texels, o.lookup.metres, device->info().name);
  fmt::print("casters in the lights' frustums   {:>12}\n", found.in_light);
  fmt::print("towards what the cameras see      {:>12}  {:.3f}\n", found.towards_it,
             share(found.towards_it, found.in_light));
  fmt::print("with a shadow on what is visible  {:>12}  {:.3f}\n", found.kept,
             share(found.kept, found.in_light));
  fmt::print("pixels that are not wholly lit    {:>12}  {:.3f}\n", found.shaded_pixels,
             share(found.shaded_pixels, found.pixels));
  fmt::print("pixels that dropped casters change{:>12}  in {} views\n", found.different_pixels,
             found.different_views);
  if (found.first_different) fmt::print("\nview {} is lit otherwise\n", *found.first_different);
  return found.different_pixels == 0 ? Exit::done : Exit::check_failed;
}

}  // namespace

void add_casters(CLI::App& app, int& exit) {
  CLI::App& command = *app.add_subcommand(
      "casters",
      "Prove on a Vulkan device that dropped shadow casters change no lit picture; exit 1 if one does");
  auto call = std::make_shared<CastersCall>();
  measure::CasterOptions& o = call->options;
  command.add_option("SCENE", call->scene, kSceneHelp)->required();
  command.add_option("--light", call->light, "of each view, at a random place")
      ->check(CLI::IsMember({"directional", "spot"}))
      ->capture_default_str();
  command.add_option("--views", call->views, "random views")
      ->transform(whole(1, 1000000))
      ->capture_default_str();
  command.add_option("--seed", o.seed, "of the views and their lights")
      ->transform(whole(0, kAnySeed))
      ->capture_default_str();
  command.add_option("--size", call->size, "of the cameras' pictures in pixels")
      ->type_name("WxH")
      ->capture_default_str();
  command.add_option("--distance", o.distance, "metres: how far cameras see and shadows are drawn")
      ->check(number(1, 100000))
      ->capture_default_str();
  command.add_option("--map", o.map, "texels across the shadow map")
      ->transform(whole(16, 8192))
      ->capture_default_str();
  command.add_option("--reach", o.lookup.reach, "texels to either side that each point asks, too")
      ->transform(whole(0, 7))
      ->capture_default_str();
  command
      .add_option("--offset", o.lookup.metres,
                  "metres that each point moves along its normal before, which keeps surfaces from shading "
                  "themselves")
      ->check(number(0, 1000))
      ->capture_default_str();
  command.add_option("--picture", call->picture, "write the last view's lit picture there")
      ->check(output_file(".png"))
      ->type_name("FILE.png");
  command.add_option("--device", call->device, "a Vulkan device by index or part of its name, or any")
      ->type_name("NAME")
      ->capture_default_str();
  add_faces(command, call->faces);
  on_run(command, exit, [call] { return run_casters(*call); });
}

}  // namespace sightline::app
