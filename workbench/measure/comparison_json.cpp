#include "workbench/measure/comparison_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include <sightline/version.hpp>

#include "workbench/io/text_file.hpp"

namespace sightline::measure {
namespace {

using Json = nlohmann::ordered_json;

Json row_json(const Comparison& comparison, const Row& row) {
  Json out;
  out["scene"] = comparison.scene;
  out["method"] = row.method;
  out["guarantee"] = to_string(row.guarantee);
  out["view"] = row.view;
  out["objects"] = row.stats.objects;
  out["tested"] = row.stats.tested;
  out["visible"] = row.kept;
  out["culled"] = row.stats.objects - std::min(row.kept, row.stats.objects);
  out["culled_frustum"] = row.stats.culled_frustum;
  out["culled_contribution"] = row.stats.culled_contribution;
  out["culled_facing"] = row.stats.culled_facing;
  out["culled_occlusion"] = row.stats.culled_occlusion;
  out["nodes_visited"] = row.stats.nodes_visited;
  out["rays"] = row.stats.rays;
  out["draw_calls"] = row.stats.draw_calls;
  out["triangles"] = row.stats.triangles;
  out["cull_vertices"] = row.stats.cull_vertices;
  out["cull_cpu_ms"] = row.cull.median;
  out["cull_cpu_ms_min"] = row.cull.min;
  out["cull_cpu_ms_max"] = row.cull.max;
  const auto time = [&](const std::string& name, const std::optional<Timing>& timing) {
    out[name] = timing ? Json(timing->median) : Json();
    if (!timing) return;
    out[name + "_min"] = timing->min;
    out[name + "_max"] = timing->max;
  };
  time("cull_gpu_ms", row.cull_gpu);
  time("frame_ms", row.frame);
  out["fps"] = row.frame && row.frame->median > 0 ? Json(1000 / row.frame->median) : Json();
  out["truly_visible"] = row.truly_visible;
  out["lost_objects"] = row.lost_objects;
  out["lost_pixels"] = row.lost_pixels;
  out["excess_objects"] = row.excess_objects;
  return out;
}

}  // namespace

Json to_json(const Comparison& comparison) {
  const Machine& machine = comparison.machine;
  Json out;
  out["sightline"] = kVersion;
  out["machine"] = {{"cpu", machine.cpu},
                    {"cores", machine.cores},
                    {"memory", machine.memory},
                    {"os", machine.os},
                    {"compiler", machine.compiler}};
  out["device"] = comparison.device;
  out["raster_state"] = to_string(comparison.raster_state);
  out["path"] = comparison.path;
  out["size"] = {comparison.width, comparison.height};
  out["rows"] = Json::array();
  for (const Row& row : comparison.rows) out["rows"].push_back(row_json(comparison, row));
  return out;
}

void write_json(const std::filesystem::path& file, const Comparison& comparison) {
  // A scene's name comes from a file name and need not be UTF-8; JSON must be.
  io::write_file(file, to_json(comparison).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace sightline::measure
