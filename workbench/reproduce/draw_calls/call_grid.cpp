#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/device/triangle_draws.hpp"
#include "workbench/measure/timing.hpp"
#include "workbench/methods/draw_calls/flat_triangles.hpp"
#include "workbench/reproduce/draw_calls/draw_calls.hpp"

namespace sightline::reproduce {

namespace {

/// The paper's set of random triangles on the device, all in view.
class Soup {
public:
  Soup(device::Device& device, const DrawCallOptions& options)
      : scene_(generate_world("soup?triangles=500000&edge=0.3")),
        flat_(methods::flatten(scene_)),
        renderer_(device, scene_),
        draws_(renderer_, geometry()),
        view_(or_throw(
            make_view({.eye = scene_.viewpoints.back().eye, .forward = scene_.viewpoints.back().forward},
                      options.width, options.height))) {}

  /// Milliseconds of a frame of the first triangles, in groups of equal size.
  double draw(std::uint64_t triangles, std::uint64_t calls) {
    commands_.clear();
    for (std::uint64_t c = 0; c < calls; ++c) {
      const auto first = static_cast<std::uint32_t>(c * triangles / calls),
                 end = static_cast<std::uint32_t>((c + 1) * triangles / calls);
      commands_.push_back({3 * (end - first), 1, 3 * first, 0, first});
    }
    const auto record = [&](device::Recorder& recorder) {
      draws_.draw(recorder, commands_, Submission::calls);
    };
    return renderer_.frame(view_, record).frame_ms;
  }

private:
  [[nodiscard]] TriangleGeometry geometry() const {
    TriangleGeometry geometry;
    geometry.positions = flat_.positions, geometry.indices = flat_.indices, geometry.objects = flat_.objects;
    return geometry;
  }

  Scene scene_;
  methods::FlatTriangles flat_;
  device::Renderer renderer_;
  device::TriangleDraws draws_;
  View view_;
  std::vector<DrawCommand> commands_;
};

}  // namespace

CallRates measure_call_rates(device::Device& device, const DrawCallOptions& options,
                             const Progress& progress) {
  CallRates rates = published_rates();  // the same rows and columns
  rates.fps.clear();
  Soup soup(device, options);
  const std::size_t columns = rates.calls.size(), cells = rates.triangles.size() * columns;
  std::vector<std::vector<double>> times(cells);
  const std::size_t rounds = options.quick ? 5 : 20;
  for (std::size_t round = 0; round <= rounds; ++round) {
    for (std::size_t k = 0; k < cells; ++k) {
      // To and fro, and from another cell each time.
      const std::size_t turn = (round % 2 == 0 ? k : cells - 1 - k), cell = (turn + 7 * round) % cells;
      const double ms = soup.draw(static_cast<std::uint64_t>(rates.triangles[cell / columns]),
                                  static_cast<std::uint64_t>(rates.calls[cell % columns]));
      if (round > 0) times[cell].push_back(ms);  // the first compiles
    }
    if (progress) progress(round + 1, rounds + 1);
  }
  for (auto& samples : times) rates.fps.push_back(1000 / measure::typical_of(samples));
  return rates;
}

}  // namespace sightline::reproduce
