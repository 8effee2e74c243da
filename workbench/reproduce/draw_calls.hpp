// Serpa, Serpa & Rodrigues: table 1 (triangles × draw calls) and walks through game levels with every
// structure, variant and height, drawn by Vulkan.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <sightline/workbench/progress.hpp>
#include <sightline/workbench/triangle_draws.hpp>

#include "workbench/camera/camera_path.hpp"
#include "workbench/device/frame_times.hpp"
#include "workbench/measure/timing.hpp"
#include "workbench/report/table.hpp"
#include "workbench/reproduce/draw_call_levels.hpp"

namespace sightline::reproduce {

struct DrawCallOptions {
  bool quick = false;
  std::uint32_t width = 320, height = 180;
};

/// Frame times of n triangles in d draw calls. All cells take turns, so that none has a quieter machine.
struct CallGrid {
  std::vector<std::uint32_t> triangles, calls;
  std::vector<double> ms;  ///< triangles × calls, means of the quicker four fifths
  double call_us = 0;      ///< what a call adds, microseconds: the slope along the calls, mean of all rows
  double triangle_ns = 0;  ///< what a triangle adds: the slope along the triangles with one call
};

CallGrid measure_call_grid(device::Device& device, const DrawCallOptions& options,
                           const Progress& progress = {});
/// Ours beside the paper's, both as shares of their first cell. Of the paper's cells two are known here.
report::Table table_of(const CallGrid& grid);
/// Whether frame rates fall along both axes, in sentences.
std::string findings(const CallGrid& grid);

/// What draws cost on a device, fitted to measured frames by least squares.
struct DrawCosts {
  double call_ns = 0, command_ns = 0, triangle_ns = 0;
};

inline constexpr std::array<std::string_view, 3> kWalkVariants{"simple", "drawcall-wise", "zhang"};
inline constexpr std::array<std::string_view, 3> kWalkStructures{"grid", "octree", "kd-tree"};

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
  double draw_calls = 0, ranges = 0, triangles = 0;
  std::uint64_t bytes = 0, lost_pixels = 0;
  std::vector<double> frame_ms_by_view;
  double small_frame_ms = 0;  ///< in the small picture; simple, drawcall-wise, none and nothing
  /// Of the final among the quickest: mean over its views of the mean of the quicker four fifths of the
  /// rounds. 0 for who was not in it.
  double final_ms = 0;

  /// Exact and neither `adaptive` nor `none` nor `nothing`.
  [[nodiscard]] bool may_be_best() const noexcept;
  [[nodiscard]] double fps() const noexcept { return frame_ms > 0 ? 1000 / frame_ms : 0; }
};

struct LevelWalk {
  std::string level, kind;
  std::uint64_t triangles = 0;
  std::size_t views = 0, final_views = 0;
  DrawCosts costs;
  std::string adaptive_way;  ///< what adaptive settled on
  bool adaptive_settled = false;
  std::size_t learning_frames = 0;  ///< that it took for that
  std::vector<WalkRow> rows;
  camera::CameraPath path;

  [[nodiscard]] const WalkRow& row(std::string_view method) const;
  /// The quickest exact one in the final, `adaptive` and `none` apart.
  [[nodiscard]] const WalkRow& best() const;
  /// At which a family, each range a call of its own, drew its frames quickest.
  [[nodiscard]] int best_height(std::string_view family) const;
};

/// Everything opaque, as in the paper. Methods take turns view by view. Throws Error where the level is
/// missing.
LevelWalk walk_level(device::Device& device, const LevelChoice& level, const DrawCallOptions& options,
                     const Progress& progress = {});

report::Table heights_table(const LevelWalk& walk);     ///< fps of every structure × variant × height
report::Table calls_table(const LevelWalk& walk);       ///< simple against drawcall-wise at every height
report::Table methods_table(const LevelWalk& walk);     ///< each method at its best height, and what beats it
report::Table submission_table(const LevelWalk& walk);  ///< calls, multi-draw, merged
/// Sentences on the paper's claims: what held, with figures.
std::string findings(const LevelWalk& walk);

/// index.html with tables, charts of the frame rate along the walks, and each level from above with its
/// cells.
void write_draw_call_report(const std::filesystem::path& folder, const std::string& device,
                            const CallGrid& grid, const std::vector<LevelWalk>& walks);

}  // namespace sightline::reproduce
