// Measuring methods against each other along a camera path, and their answers against the truth.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sightline/workbench/progress.hpp>

#include "workbench/camera/camera_path.hpp"
#include "workbench/measure/bench.hpp"
#include "workbench/measure/machine.hpp"
#include "workbench/measure/timing.hpp"

namespace sightline::measure {

/// One method in one view.
struct Row {
  std::string method;
  Guarantee guarantee = Guarantee::exact;
  std::size_t view = 0;
  CullStats stats;
  std::uint64_t kept = 0;           ///< objects in the method's visible set
  std::uint64_t truly_visible = 0;  ///< objects with a pixel in the item buffer
  Timing cull;                      ///< on the CPU
  /// Where a device drew. Occluders: depth that culling alone reads; frame: all of it, from start to end.
  std::optional<Timing> cull_gpu, occluders, frame;
  std::uint64_t lost_objects = 0, lost_pixels = 0, excess_objects = 0;
};

struct Comparison {
  std::string scene, path, device = "cpu";
  RasterState raster_state = RasterState::materials;  ///< that "exact" speaks of
  Machine machine;
  std::uint32_t width = 0, height = 0;
  std::vector<std::string> methods;
  std::vector<Camera> cameras;
  std::vector<Row> rows;  ///< view by view, methods in their order

  /// Whether a device drew the frames, rather than the CPU culling alone.
  [[nodiscard]] bool drawn() const noexcept { return device != "cpu"; }
};

struct MeasureOptions {
  std::uint32_t width = 1280, height = 720;
  std::size_t warm_up = 2;  ///< frames of each method and view that are not counted
  std::size_t repeats = 9;  ///< turns that are
  /// On the CPU: a method that has taken longer in a view is not repeated, only counted once.
  double patience_ms = 200;
  /// On a device: frames of each method and view that tell what their passes took on the GPU, and nothing
  /// else: they are the slower for it.
  std::size_t timed_passes = 5;
  /// On a device: turns more in each view of the eight that may be the quickest, among themselves and kLimit;
  /// twice as many of the quicker half, and four times of the two that are left.
  std::size_t finals = 0;
  double moving = 0;  ///< share of the objects that move before every frame
  /// One more subject, kLimit: what the item buffer sees and nothing else, found for nothing. No culling of
  /// whole objects leaves less to draw. Not where objects move.
  bool limit = false;
};

inline constexpr std::string_view kLimit = "(limit)";

/// For each view, all methods by turns in an order that is drawn anew each round, so that drift of the
/// machine hits all alike; then the oracle. On a device a turn is two frames, of which the second counts: the
/// first finds the caches full of what the others left there, as no frame of a program with one method does.
/// Where objects move, it is one. The finals come last. Throws Error for a camera that makes no view and for
/// an impossible visible set.
Comparison compare(Bench& bench, const camera::CameraPath& path, const MeasureOptions& options,
                   const Progress& progress = {});

/// Who may be the quickest, quickest first: of the methods that lost nothing and promise so, up to `most`
/// whose frames came close, as places in `methods`; and kLimit behind them, so that what is held beside it
/// ran beside it. Of a comparison whose frames were drawn.
std::vector<std::size_t> finalists(const Comparison& so_far, std::size_t most);

}  // namespace sightline::measure
