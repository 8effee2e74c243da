// sightline reproduce ray-pvs: Ye et al. 2023, table 6 and figures 12 and 13.
#include <fmt/format.h>

#include <algorithm>

#include "command.hpp"
#include "device.hpp"
#include "lab/reproduce/ray_pvs.hpp"
#include "reproduce_ray_pvs.hpp"

namespace sightline::app {

int run_ray_pvs(bool quick, const std::string& device_name, const std::string& report) {
  const std::unique_ptr<vulkan::Device> device = open_device(device_name);
  lab::RayPvsOptions options;
  options.repeats = quick ? 2 : 9;
  options.pictures = report;
  std::vector<lab::RayPvsModel> models;
  const auto shown = progress("reproduce");
  for (int model = 1; model <= 5; ++model) {
    models.push_back(lab::measure_ray_model(model, *device, options));
    if (shown) shown(static_cast<std::size_t>(model), 5);
  }
  fmt::print(
      "Ye et al. 2023, table 6: 100 x 100 rays, one thread on the CPU, {} as the GPU; medians of {}\n\n{}\n",
      device->info().name, options.repeats, lab::render(lab::ray_table(models)));
  double share = 0;
  for (const lab::RayPvsModel& m : models) share = std::max(share, m.timing[2].total() / m.timing[0].total());
  fmt::print("iwcpa takes at most {:.2f} of toca's time.\n\n", share);
  fmt::print("Apart, ms:\n\n{}\n", lab::render(lab::ray_parts_table(models)));
  fmt::print("Figure 12 in figures, against the item buffer at 1280x720:\n\n{}\n",
             lab::render(lab::ray_loss_table(models)));
  if (!report.empty())
    fmt::print("Figure 12: {}/model-N-everything.png, -pvs.png and -difference.png\n\n", report);
  lab::Table regions;
  regions.header = {"region", "kept", "everything ms", "PVS ms", "ratio"};
  for (const lab::RegionTime& r : lab::measure_regions(1, *device, options)) {
    regions.rows.push_back({fmt::format("row {}, column {}", r.row + 1, r.column + 1),
                            lab::format_count(static_cast<double>(r.kept)), lab::format_ms(r.everything_ms),
                            lab::format_ms(r.pvs_ms), fmt::format("{:.2f}", r.everything_ms / r.pvs_ms)});
  }
  fmt::print("Figure 13: a frame of model 1 by region, everything drawn and the PVS alone\n\n{}",
             lab::render(regions));
  expect_silence(*device);
  const bool alike = std::all_of(models.begin(), models.end(), [](const auto& m) { return m.identical; });
  return alike ? Exit::done : Exit::check_failed;
}

}  // namespace sightline::app
