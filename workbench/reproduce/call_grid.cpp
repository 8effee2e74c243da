#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/device/triangle_draws.hpp"
#include "workbench/methods/draw_calls/flat_triangles.hpp"
#include "workbench/reproduce/draw_calls.hpp"

namespace sightline::reproduce {

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

/// Random triangles on the device, all in view.
class Soup {
public:
  Soup(device::Device& device, std::uint32_t triangles, const DrawCallOptions& options)
      : triangles_(triangles),
        scene_(generate_world(fmt::format("soup?triangles={}&edge=0.3", triangles))),
        flat_(methods::flatten(scene_)),
        renderer_(device, scene_),
        draws_(renderer_, geometry()),
        view_(or_throw(
            make_view({.eye = scene_.viewpoints.back().eye, .forward = scene_.viewpoints.back().forward},
                      options.width, options.height))) {}

  /// Milliseconds of a frame.
  double draw(std::uint32_t calls) {
    const std::vector<DrawCommand> commands = ranges(triangles_, calls);
    return renderer_
        .frame(view_, [&](device::Recorder& recorder) { draws_.draw(recorder, commands, Submission::calls); })
        .frame_ms;
  }

private:
  [[nodiscard]] TriangleGeometry geometry() const {
    TriangleGeometry geometry;
    geometry.positions = flat_.positions, geometry.indices = flat_.indices, geometry.objects = flat_.objects;
    return geometry;
  }

  std::uint32_t triangles_;
  Scene scene_;
  methods::FlatTriangles flat_;
  device::Renderer renderer_;
  device::TriangleDraws draws_;
  View view_;
};

}  // namespace

CallGrid measure_call_grid(device::Device& device, const DrawCallOptions& options, const Progress& progress) {
  CallGrid grid;
  grid.triangles = {100000, 200000, 300000, 400000, 500000};
  grid.calls = {1, 10, 100, 1000, 10000, 100000};
  std::vector<std::unique_ptr<Soup>> soups;
  for (const std::uint32_t triangles : grid.triangles)
    soups.push_back(std::make_unique<Soup>(device, triangles, options));
  const std::size_t columns = grid.calls.size(), rows = grid.triangles.size(), cells = rows * columns;
  std::vector<std::vector<double>> times(cells);
  const std::size_t rounds = options.quick ? 11 : 20;
  for (std::size_t round = 0; round <= rounds; ++round) {
    for (std::size_t k = 0; k < cells; ++k) {
      // To and fro, and from another cell each time.
      const std::size_t turn = (round % 2 == 0 ? k : cells - 1 - k), cell = (turn + 7 * round) % cells;
      const double ms = soups[cell / columns]->draw(grid.calls[cell % columns]);
      if (round > 0) times[cell].push_back(ms);  // the first compiles
    }
    if (progress) progress(round + 1, rounds + 1);
  }
  for (auto& samples : times) grid.ms.push_back(measure::typical_of(samples));
  for (std::size_t n = 0; n < rows; ++n) {
    grid.call_us += 1000 * (grid.ms[n * columns + columns - 1] - grid.ms[n * columns]) /
                    (grid.calls.back() - 1) / static_cast<double>(rows);
  }
  grid.triangle_ns =
      1e6 * (grid.ms[(rows - 1) * columns] - grid.ms[0]) / (grid.triangles.back() - grid.triangles.front());
  return grid;
}

report::Table table_of(const CallGrid& grid) {
  report::Table table;
  table.header = {"triangles"};
  for (const std::uint32_t calls : grid.calls)
    table.header.push_back(report::format_count(calls) + (calls == 1 ? " call" : " calls"));
  for (std::size_t n = 0; n < grid.triangles.size(); ++n) {
    std::vector<std::string> fps{report::format_count(grid.triangles[n]) + ", fps"},
        share{"  of the first cell"};
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

std::string findings(const CallGrid& grid) {
  constexpr double kNoise = 1.05;  // frame rates that differ by less are taken for equal
  const std::size_t columns = grid.calls.size(), rows = grid.triangles.size();
  std::string rises;
  std::size_t falls = 0, steps = 0;
  const auto step = [&](std::size_t from, std::size_t to) {
    const double ratio = grid.ms[from] / grid.ms[to];  // of the frame rates
    ++steps;
    falls += ratio < 1 / kNoise;
    if (ratio <= kNoise) return;
    rises += fmt::format(" From {} triangles in {} calls to {} in {} it rises by {:.0f} %.",
                         grid.triangles[from / columns], grid.calls[from % columns],
                         grid.triangles[to / columns], grid.calls[to % columns], 100 * (ratio - 1));
  };
  const auto report = [&](std::string_view along) {
    const std::string line =
        fmt::format("Along the {} the frame rate falls in {} of {} steps, and {}\n", along, falls, steps,
                    rises.empty() ? "never rises by more than 5 %." : "not everywhere:" + rises);
    rises.clear(), falls = steps = 0;
    return line;
  };
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t n = 1; n < rows; ++n) step((n - 1) * columns + c, n * columns + c);
  }
  std::string out = report("triangles");
  for (std::size_t n = 0; n < rows; ++n) {
    for (std::size_t c = 1; c < columns; ++c) step(n * columns + c - 1, n * columns + c);
  }
  out += report("calls");
  return out + fmt::format(
                   "A call costs {:.2f} µs, as much as {:.0f} triangles of {:.0f} ns: a thousand calls add "
                   "{:.1f} ms "
                   "to frames of {:.0f} to {:.0f} ms. (On the paper's GPU, from its two cells: {:.2f} µs.)\n",
                   grid.call_us, 1000 * grid.call_us / grid.triangle_ns, grid.triangle_ns, grid.call_us,
                   grid.ms.front(), grid.ms[(rows - 1) * columns],
                   1e6 * (1 / kPublishedMostCalls - 1 / kPublishedOneCall) / (grid.calls.back() - 1));
}

}  // namespace sightline::reproduce
