// sightline reproduce ray-pvs: Ye et al. 2023, table 6 and figures 12 and 13.
#include <fmt/format.h>

#include <algorithm>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "command.hpp"
#include "device.hpp"
#include "reproduce_ray_pvs.hpp"
#include "workbench/reproduce/ray_pvs.hpp"

namespace sightline::app {

namespace {

// The scenes that the five methods are held equal on.
std::vector<reproduce::RayScene> measure_scenes(std::size_t views) {
  std::vector<std::string> names;
  for (int model = 1; model <= 5; ++model) names.push_back(fmt::format("world:strata?model={}", model));
  names.emplace_back("world:irregular");
  names.emplace_back("pak1-maps.pk3:maps/oa_dm1.bsp");
  std::vector<reproduce::RayScene> scenes;
  const auto shown = progress("rays against triangles");
  for (const std::string& name : names) {
    Scene scene;
    try {
      scene = load_scene(name);
    } catch (const Error& error) {
      fmt::print("left out: {}\n", error.what());  // the levels are a package of their own
      continue;
    }
    scenes.push_back(reproduce::measure_ray_scene(scene, views));
    if (shown) shown(scenes.size(), names.size());
  }
  return scenes;
}

}  // namespace

int run_ray_pvs(bool quick, const std::string& device_name, const std::string& report) {
  const std::unique_ptr<device::Device> device = open_device(device_name);
  reproduce::RayPvsOptions options;
  options.repeats = quick ? 2 : 9;
  options.pictures = report;
  std::vector<reproduce::RayPvsModel> models;
  const auto shown = progress("reproduce");
  for (int model = 1; model <= 5; ++model) {
    models.push_back(reproduce::measure_ray_model(model, *device, options));
    if (shown) shown(static_cast<std::size_t>(model), 5);
  }
  fmt::print(
      "Ye et al. 2023, table 6: 100 x 100 rays, one thread on the CPU, {} as the GPU; medians of {}\n\n{}\n",
      device->info().name, options.repeats, report::render(reproduce::ray_table(models)));
  double share = 0;
  for (const reproduce::RayPvsModel& m : models)
    share = std::max(share, m.timing[2].total() / m.timing[0].total());
  fmt::print("iwcpa takes at most {:.2f} of toca's time.\n\n", share);
  fmt::print("Apart, ms:\n\n{}\n", report::render(reproduce::ray_parts_table(models)));
  fmt::print("Figure 12 in figures, against the item buffer at 1280x720:\n\n{}\n",
             report::render(reproduce::ray_loss_table(models)));
  const std::vector<reproduce::RegionTime> regions = reproduce::measure_regions(1, *device, options);
  fmt::print("Figure 13: a frame of model 1 by region, everything drawn and the PVS alone\n\n{}\n",
             report::render(reproduce::region_table(regions)));
  const std::vector<reproduce::RayScene> scenes = measure_scenes(quick ? 4 : 20);
  fmt::print("Rays against triangles, against the item buffer at {}x{}; guided's target {:g} %\n\n{}",
             reproduce::kRaySceneWidth, reproduce::kRaySceneHeight, 100 * reproduce::kGuidedTarget,
             report::render(reproduce::ray_scene_table(scenes)));
  if (!report.empty()) {
    reproduce::write_ray_report(device->info().name, options, models, regions, scenes);
    fmt::print("\nThe report, with figure 12's pictures: {}/index.html\n", report);
  }
  expect_silence(device.get());
  const bool alike = std::all_of(models.begin(), models.end(), [](const auto& m) { return m.identical; });
  return alike ? Exit::done : Exit::check_failed;
}

}  // namespace sightline::app
