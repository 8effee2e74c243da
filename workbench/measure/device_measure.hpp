// Measuring methods on a device: the same loop as on the CPU, with the times of the GPU and of the whole
// frame.
#pragma once

#include <string_view>

#include "workbench/measure/measure.hpp"
#include "workbench/measure/workbench.hpp"

namespace sightline::measure {

struct DeviceMeasureOptions {
  MeasureOptions measure;
  /// Frames of each method and view that tell what their passes took on the GPU, and nothing else: they are
  /// the slower for it.
  std::size_t timed_passes = 5;
  double moving = 0;  ///< share of the objects that move before every frame
  /// One more contestant, kLimit: what the item buffer sees and nothing else, found for nothing. No culling
  /// of whole objects draws a frame faster. Not where objects move.
  bool limit = false;
};

inline constexpr std::string_view kLimit = "(limit)";

/// For each view all methods by turns, in an order that rotates; lost and excess objects against the device's
/// own item buffer. Throws Error as compare() does.
Comparison compare_on_device(Workbench& bench, const camera::CameraPath& path,
                             const DeviceMeasureOptions& options, const Progress& progress = {});

}  // namespace sightline::measure
