// What a comparison on a device says, as a table and a sentence.
#pragma once

#include "workbench/measure/device_verify.hpp"
#include "workbench/measure/measure.hpp"
#include "workbench/report/table.hpp"

namespace sightline::report {

/// One line a method: means over the views, medians of times.
Table device_table(const measure::Comparison& comparison);
/// Which method drew its frames fastest without losing anything.
std::string device_verdict(const measure::Comparison& comparison);
/// How many times as fast as the first method's frames the others' are, over the views in which less than
/// `share` of the scene's objects is visible: one line a method, the median, least and greatest.
Table device_ratios(const measure::Comparison& comparison, double share = 0.2);
Table verification_table(const measure::DeviceVerification& verification);

/// Means over the views of one method on a device.
struct DeviceSummary {
  std::string method;
  Guarantee guarantee = Guarantee::exact;
  double kept = 0, visible = 0, excess = 0, cull_vertices = 0, draw_calls = 0, triangles = 0;
  double cpu_ms = 0, gpu_ms = 0, frame_ms = 0;
  std::uint64_t lost_objects = 0, lost_pixels = 0;

  [[nodiscard]] double fps() const noexcept { return frame_ms > 0 ? 1000 / frame_ms : 0; }
};
std::vector<DeviceSummary> summarise_on_device(const measure::Comparison& comparison);

}  // namespace sightline::report
