// Measuring methods against each other along a camera path, and their answers against the truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sightline/workbench/frame.hpp>
#include <sightline/workbench/method.hpp>

#include "workbench/camera/camera_path.hpp"
#include "workbench/measure/contestant.hpp"
#include "workbench/measure/machine.hpp"
#include "workbench/measure/verify.hpp"
#include "workbench/oracle/embree_judge.hpp"

namespace sightline::measure {

/// Milliseconds over the repeats.
struct Timing {
  double median = 0, min = 0, max = 0;
};

/// Median, least and greatest; zeros for no samples. Sorts the samples.
Timing timing_of(std::span<double> milliseconds) noexcept;

/// The mean of the quicker four fifths; 0 for no samples. Sorts the samples. Frames of a software rasteriser
/// come in two speeds, by where its threads happen to run: medians jump from one to the other, means do not.
double typical_of(std::span<double> milliseconds) noexcept;

/// One method in one view.
struct Row {
  std::string method;
  Guarantee guarantee = Guarantee::exact;
  std::size_t view = 0;
  CullStats stats;
  std::uint64_t kept = 0;           ///< objects in the method's visible set
  std::uint64_t truly_visible = 0;  ///< objects with a pixel in the item buffer
  Timing cull;                      ///< on the CPU
  std::optional<Timing> cull_gpu,
      frame;  ///< where a device drew; frame: culling and drawing, from start to end
  std::uint64_t lost_objects = 0, lost_pixels = 0, excess_objects = 0;
};

struct Comparison {
  std::string scene, path, device = "cpu";
  Machine machine;
  std::uint32_t width = 0, height = 0;
  std::vector<std::string> methods;
  std::vector<Camera> cameras;
  std::vector<Row> rows;  ///< view by view, methods in their order
};

struct MeasureOptions {
  std::uint32_t width = 1280, height = 720;
  std::size_t warm_up = 2;   ///< culls of each method and view that are not counted
  std::size_t repeats = 9;   ///< that are
  double patience_ms = 200;  ///< a method that has taken longer in a view is not repeated, only counted once
};

/// For each view, all methods by turns in an order that rotates, so that drift of the machine hits all alike;
/// then the item buffer. Throws Error for a camera that makes no view and for an impossible visible set.
Comparison compare(const Scene& scene, const oracle::EmbreeJudge& judge,
                   std::span<const Contestant> contestants, const camera::CameraPath& path,
                   const MeasureOptions& options, const Progress& progress = {});

/// {"sightline": version, "machine": {…}, "device": "cpu", "rows": […]}; fields without a value are null.
nlohmann::ordered_json to_json(const Comparison& comparison);

/// Writes the JSON, all or nothing. Throws Error where the disk is full or the file cannot be made.
void write_json(const std::filesystem::path& file, const Comparison& comparison);

}  // namespace sightline::measure
