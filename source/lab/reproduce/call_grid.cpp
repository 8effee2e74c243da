#include <fmt/format.h>

#include <algorithm>

#include <sightline/error.hpp>
#include <sightline/worlds.hpp>

#include "lab/reproduce/draw_calls.hpp"
#include "methods/draw_calls/flat_triangles.hpp"
#include "vulkan/triangle_draws.hpp"

namespace sightline::lab {

namespace {

// The two cells of table 1 that are known here: one call and 100,000 calls, of 100,000 triangles (fps).
constexpr double kPublishedOneCall = 577, kPublishedMostCalls = 47;

std::vector<DrawCommand> ranges(std::uint32_t triangles, std::uint32_t calls) {
  std::vector<DrawCommand> draws;
  for (std::uint64_t c = 0; c < calls; ++c) {
    const auto first = static_cast<std::uint32_t>(c * triangles / calls),
               end = static_cast<std::uint32_t>((c + 1) * triangles / calls);
    draws.push_back({3 * (end - first), 1, 3 * first, 0, first});
  }
  return draws;
}

}  // namespace

CallGrid measure_call_grid(vulkan::Device& device, const DrawCallOptions& options, const Progress& progress) {
  CallGrid grid;
  grid.triangles = {100000, 200000, 300000, 400000, 500000};
  grid.calls = {1, 10, 100, 1000, 10000, 100000};
  const std::size_t repeats = options.quick ? 3 : 9;
  for (std::size_t n = 0; n < grid.triangles.size(); ++n) {
    const Scene scene =
        or_throw(generate_world(fmt::format("soup?triangles={}&edge=0.3", grid.triangles[n])));
    const methods::FlatTriangles flat = methods::flatten(scene);
    TriangleGeometry geometry;
    geometry.positions = flat.positions, geometry.indices = flat.indices, geometry.objects = flat.objects;
    vulkan::Renderer renderer(device, scene);
    vulkan::TriangleDraws draws(renderer, geometry);
    const Viewpoint& far = scene.viewpoints.back();
    const View view =
        or_throw(make_view({.eye = far.eye, .forward = far.forward}, options.width, options.height));
    std::vector<std::vector<double>> times(grid.calls.size());
    for (std::size_t repeat = 0; repeat <= repeats; ++repeat) {
      for (std::size_t c = 0; c < grid.calls.size(); ++c) {
        const std::vector<DrawCommand> commands = ranges(grid.triangles[n], grid.calls[c]);
        const vulkan::FrameTimes frame = renderer.frame(
            view, [&](vulkan::Recorder& recorder) { draws.draw(recorder, commands, Submission::calls); });
        if (repeat > 0) times[c].push_back(frame.frame_ms);  // the first compiles
      }
    }
    for (auto& samples : times) grid.ms.push_back(timing_of(samples).median);
    if (progress) progress(n + 1, grid.triangles.size());
  }
  const std::size_t columns = grid.calls.size(), rows = grid.triangles.size();
  for (std::size_t n = 0; n < rows; ++n) {
    grid.call_us += 1000 * (grid.ms[n * columns + columns - 1] - grid.ms[n * columns]) /
                    (grid.calls.back() - 1) / static_cast<double>(rows);
  }
  grid.triangle_ns =
      1e6 * (grid.ms[(rows - 1) * columns] - grid.ms[0]) / (grid.triangles.back() - grid.triangles.front());
  return grid;
}

Table table_of(const CallGrid& grid) {
  Table table;
  table.header = {"triangles"};
  for (const std::uint32_t calls : grid.calls)
    table.header.push_back(format_count(calls) + (calls == 1 ? " call" : " calls"));
  for (std::size_t n = 0; n < grid.triangles.size(); ++n) {
    std::vector<std::string> fps{format_count(grid.triangles[n]) + ", fps"}, share{"  of the first cell"};
    for (std::size_t c = 0; c < grid.calls.size(); ++c) {
      const double ms = grid.ms[n * grid.calls.size() + c];
      fps.push_back(fmt::format("{:.1f}", 1000 / ms));
      share.push_back(fmt::format("{:.3f}", grid.ms[0] / ms));
    }
    table.rows.push_back(std::move(fps));
    table.rows.push_back(std::move(share));
    if (n > 0) continue;
    std::vector<std::string> published(grid.calls.size() + 1, "-");
    published[0] = "  published";
    published[1] = "1.000";
    published.back() = fmt::format("{:.3f}", kPublishedMostCalls / kPublishedOneCall);
    table.rows.push_back(std::move(published));
  }
  return table;
}

}  // namespace sightline::lab
