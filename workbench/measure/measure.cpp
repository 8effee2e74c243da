#include "workbench/measure/measure.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

#include <sightline/version.hpp>
#include <sightline/workbench/error.hpp>

#include "workbench/io/text_file.hpp"
#include "workbench/oracle/loss.hpp"
#include "workbench/oracle/triangle_judge.hpp"

namespace sightline::measure {
namespace {

using Json = nlohmann::ordered_json;

double cull_milliseconds(Method& method, const View& view, Frame& frame) {
  const auto begin = std::chrono::steady_clock::now();
  method.cull(view, frame);
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

/// Times of each method in one view; the frames keep the last answers.
std::vector<std::vector<double>> take_times(std::span<const Contestant> contestants, const View& view,
                                            std::size_t turn, const MeasureOptions& options,
                                            std::vector<Frame>& frames) {
  std::vector<std::vector<double>> times(contestants.size());
  std::vector<double> spent(contestants.size(), 0);
  for (std::size_t repeat = 0; repeat < options.warm_up + options.repeats; ++repeat) {
    for (std::size_t k = 0; k < contestants.size(); ++k) {
      const std::size_t m = (k + turn + repeat) % contestants.size();
      const bool counts = repeat >= options.warm_up;
      if (spent[m] > options.patience_ms && (!counts || !times[m].empty())) continue;
      const double time = cull_milliseconds(*contestants[m].method, view, frames[m]);
      spent[m] += time;
      if (counts) times[m].push_back(time);
    }
  }
  return times;
}

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

Timing timing_of(std::span<double> ms) noexcept {
  if (ms.empty()) return {};
  std::sort(ms.begin(), ms.end());
  const std::size_t middle = ms.size() / 2;
  const double median = ms.size() % 2 == 1 ? ms[middle] : 0.5 * (ms[middle - 1] + ms[middle]);
  return {median, ms.front(), ms.back()};
}

double typical_of(std::span<double> ms) noexcept {
  if (ms.empty()) return 0;
  std::sort(ms.begin(), ms.end());
  const std::span quicker = ms.first(ms.size() - ms.size() / 5);
  return std::accumulate(quicker.begin(), quicker.end(), 0.0) / static_cast<double>(quicker.size());
}

Comparison compare(const Scene& scene, const oracle::EmbreeJudge& judge,
                   std::span<const Contestant> contestants, const camera::CameraPath& path,
                   const MeasureOptions& options, const Progress& progress) {
  Comparison result;
  result.scene = scene.name;
  result.path = path.name;
  result.machine = this_machine();
  result.width = options.width, result.height = options.height;
  result.cameras = path.cameras;
  for (const Contestant& contestant : contestants) result.methods.push_back(contestant.name);
  oracle::TriangleJudge triangle_judge(scene);
  std::vector<Frame> frames(contestants.size());
  for (std::size_t v = 0; v < path.cameras.size(); ++v) {
    const View view = or_throw(make_view(path.cameras[v], options.width, options.height));
    std::vector<std::vector<double>> times = take_times(contestants, view, v, options, frames);
    const oracle::ItemBuffer truth = judge.render(view);
    for (std::size_t m = 0; m < contestants.size(); ++m) {
      oracle::Loss loss;
      std::size_t truly_visible = truth.visible_count();
      if (const TriangleGeometry* geometry = contestants[m].method->geometry()) {
        oracle::TriangleJudge::Verdict found = triangle_judge.judge(view, *geometry, frames[m]);
        loss = std::move(found.loss), truly_visible = found.truly_visible;
      } else {
        loss = oracle::confirmed_loss(judge, view, truth, frames[m].visible);
      }
      Row row;
      row.method = contestants[m].name;
      row.guarantee = contestants[m].method->guarantee();
      row.view = v;
      row.stats = frames[m].stats;
      row.stats.objects = scene.size();
      row.kept = frames[m].visible.size();
      row.truly_visible = truly_visible;
      row.cull = timing_of(times[m]);
      row.lost_objects = loss.lost.size();
      row.lost_pixels = loss.lost_pixels;
      row.excess_objects = loss.excess.size();
      result.rows.push_back(std::move(row));
    }
    if (progress) progress(v + 1, path.cameras.size());
  }
  return result;
}

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
