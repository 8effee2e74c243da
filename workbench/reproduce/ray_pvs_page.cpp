// The page of `reproduce ray-pvs`: table 6, and figures 12 and 13.
#include <fmt/format.h>

#include <filesystem>

#include "workbench/io/text_file.hpp"
#include "workbench/report/assets.hpp"
#include "workbench/report/page.hpp"
#include "workbench/reproduce/ray_pvs.hpp"

namespace sightline::reproduce {

void write_ray_report(const std::string& device, const RayPvsOptions& options,
                      const std::vector<RayPvsModel>& models, const std::vector<RegionTime>& regions,
                      std::span<const RayScene> scenes) {
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Ray-cast visible "
      "sets</title><style>";
  page += report::kPageStyle;
  page += fmt::format(
      "</style></head><body><main><h1>Ray-cast visible sets: Ye et al. 2023</h1>\n<p>{0} × {0} rays, one "
      "thread on the CPU, {1} as the GPU; medians of {2}.</p>\n<h2>Table 6</h2>\n",
      options.rays, report::escape(device), options.repeats);
  page += report::html(ray_table(models)) + "<h3>Apart</h3>\n" + report::html(ray_parts_table(models));
  page += fmt::format("<h2>Figure 12: what the set lacks, {}x{}</h2>\n", options.width, options.height) +
          report::html(ray_loss_table(models));
  for (const RayPvsModel& model : models) {
    page += fmt::format("<h3>Model {}</h3>\n", model.model);
    for (const auto& [file, caption] : {std::pair{"everything", "everything"},
                                        {"pvs", "the PVS alone"},
                                        {"difference", "red where they differ"}}) {
      page += fmt::format(
          "<figure><a href=\"model-{0}-{1}.png\"><img src=\"model-{0}-{1}.png\" alt=\"model {0}: {2}\" "
          "style=\"max-width:100%\"></a><figcaption>{2}</figcaption></figure>\n",
          model.model, file, caption);
    }
  }
  page += "<h2>Figure 13: a frame of model 1 by region</h2>\n" + report::html(region_table(regions));
  page += fmt::format("<h2>Rays against triangles, {}x{}</h2>\n", kRaySceneWidth, kRaySceneHeight) +
          report::html(ray_scene_table(scenes));
  io::write_file(std::filesystem::path(options.pictures) / "index.html", page + "</main></body></html>\n");
}

}  // namespace sightline::reproduce
