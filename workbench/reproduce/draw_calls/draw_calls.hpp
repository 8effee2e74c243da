// Serpa, Serpa & Rodrigues: table 1 (triangles × draw calls), and walks through game levels with every
// structure, variant and height, drawn by Vulkan.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sightline/workbench/progress.hpp>
#include <sightline/workbench/triangle_draws.hpp>

#include "workbench/camera/camera_path.hpp"
#include "workbench/device/frame_times.hpp"
#include "workbench/methods/draw_calls/draw_calls.hpp"
#include "workbench/reproduce/draw_calls/call_rates.hpp"
#include "workbench/reproduce/draw_calls/draw_call_levels.hpp"
#include "workbench/reproduce/reproduction.hpp"

namespace sightline::reproduce {

struct DrawCallOptions {
  bool quick = false;
  std::uint32_t width = 320, height = 180;
};

/// Draws table 1: the first n of one set of 500,000 random triangles, in d calls. All cells take turns, so
/// that none has a quieter machine; each is the mean of the quicker four fifths.
CallRates measure_call_rates(device::Device& device, const DrawCallOptions& options,
                             const Progress& progress = {});

/// What draws cost on a device, fitted to measured frames by least squares.
struct DrawCosts {
  double call_ns = 0, command_ns = 0, triangle_ns = 0;
};

inline constexpr std::array<std::string_view, 3> kWalkVariants{"simple", "drawcall-wise", "zhang"};
inline constexpr std::array<std::string_view, 3> kWalkStructures{"grid", "octree", "kd-tree"};
inline constexpr std::uint32_t kHighest = 6;  ///< of the heights 1 …

/// A picture of which a software rasteriser's pixels take next to nothing, as a GPU's do, so that frames show
/// what calls and triangles cost.
inline constexpr std::uint32_t kSmallWidth = 64, kSmallHeight = 36;

/// One method along the walk. Means are over the views.
struct WalkRow {
  std::string method;  ///< its specification
  std::string family;  ///< without parameters
  std::uint32_t height = 0;
  Submission submission = Submission::calls;
  /// Means of the views' medians; recording is the CPU's part: culling and submitting.
  double frame_ms = 0, cull_ms = 0, record_ms = 0;
  double draw_calls = 0, triangles = 0, nodes_visited = 0, objects = 0;
  std::uint64_t bytes = 0, lost_pixels = 0;
  std::vector<double> frame_ms_by_view;
  double small_frame_ms = 0;  ///< in the small picture; simple, drawcall-wise, none and nothing
  /// Of the final among the quickest: mean over its views of the mean of the quicker four fifths of the
  /// rounds. 0 for who was not in it.
  double final_ms = 0;

  /// One of the nine families with no other parameter than its height.
  [[nodiscard]] bool is_of_the_paper() const noexcept;
  /// Exact, of what `adaptive` chooses among: neither itself nor `none` nor `nothing`, and without occlusion.
  [[nodiscard]] bool may_be_best() const noexcept;
  [[nodiscard]] double fps() const noexcept { return frame_ms > 0 ? 1000 / frame_ms : 0; }
};

/// How a structure is split and bounded: as in the paper, and two other ways as parameters.
inline constexpr std::string_view kPrintedCells = "", kSplitCells = "cells=tight";

/// A method, parameters and all, with the cells that `adaptive` chooses among.
std::string with_tight_cells(std::string_view method);

/// What one structure of one height makes of a level, and submits along the walk; means over its views.
struct StructureCount {
  std::string structure;
  std::uint32_t height = 0;
  std::string rules;                           ///< kPrintedCells, kSplitCells or methods::kTightCells
  double possible = 0, made = 0, visited = 0;  ///< cells, cells, nodes a frame
  double wise_calls = 0, simple_calls = 0, wise_triangles = 0;

  [[nodiscard]] double ratio() const noexcept { return wise_calls > 0 ? simple_calls / wise_calls : 0; }
};

/// Figure 10: a family at its best height along the dense walk.
struct WalkLine {
  std::string method;
  std::vector<double> fps;  ///< one a view
};

struct LevelWalk {
  std::string level, kind;
  std::uint64_t triangles = 0;
  std::size_t views = 0, final_views = 0;
  DrawCosts costs;
  std::string adaptive_way;  ///< what adaptive settled on; empty where it was not tried
  bool adaptive_settled = false;
  std::size_t learning_frames = 0;  ///< that it took for that
  std::vector<WalkRow> rows;
  std::vector<StructureCount> counts;
  std::vector<WalkLine> lines;
  std::size_t turn = 0;     ///< of the dense walk's views, how many the full turn takes
  camera::CameraPath path;  ///< the dense walk

  /// Null where there is none.
  [[nodiscard]] const WalkRow* find(std::string_view method) const noexcept;
  /// Throws Error where there is none.
  [[nodiscard]] const WalkRow& row(std::string_view method) const;
  [[nodiscard]] const StructureCount& count(std::string_view structure, std::uint32_t height,
                                            std::string_view rules) const;
  /// The quickest that may be best, by the final where one was held.
  [[nodiscard]] const WalkRow& best() const;
  /// The quickest of the nine families.
  [[nodiscard]] const WalkRow& best_of_the_paper() const;
  /// At which a family, each range a call of its own, drew its frames quickest.
  [[nodiscard]] std::uint32_t best_height(std::string_view family) const;
  [[nodiscard]] const WalkRow& at_best_height(std::string_view family) const;
};

/// "octree" at 4: 4096.
double possible_cells(std::string_view structure, std::uint32_t height);

/// A full turn on the spot, of so many views, then the walk from there on.
camera::CameraPath turn_and_walk(const Scene& scene, std::size_t turn, std::size_t steps);

/// Everything opaque, as in the paper. Methods take turns view by view. Throws Error where the level is
/// missing.
LevelWalk walk_level(device::Device& device, const LevelChoice& level, const DrawCallOptions& options,
                     const Progress& progress = {});

/// Cells, nodes and calls of every structure and height, as printed and by two rules of ours, along views.
std::vector<StructureCount> count_structures(const Scene& scene, const std::vector<View>& views);

/// All that was measured; what was not is empty.
struct DrawCallMeasurement {
  std::string machine;
  CallRates rates;
  std::vector<LevelWalk> walks;
};

/// Its tables, charts and sentences, beside what the paper prints.
Reproduction draw_calls_reproduction(const DrawCallMeasurement& measured);

/// The pictures that its page names: each level from above with its cells.
void write_level_pictures(const std::string& folder, const DrawCallMeasurement& measured);

}  // namespace sightline::reproduce
