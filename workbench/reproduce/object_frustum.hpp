// Le Hoang Minh et al. 2022: table 2, the frame's life cycle (figures 1 and 2), the walk over cells (figures
// 4 and 6), the cells of a view (figure 7), and how much the cells' size decides.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sightline/view.hpp>
#include <sightline/workbench/method.hpp>
#include <sightline/workbench/progress.hpp>
#include <sightline/workbench/scene.hpp>

#include "workbench/device/frame_times.hpp"
#include "workbench/reproduce/reproduction.hpp"

namespace sightline::reproduce {

/// Which methods table 2 is about: Unity's own way, and the paper's.
struct BothMethods {
  double grid_cell = 0, object_frustum = 0;
};

/// What a frame took, in milliseconds.
struct DrawnFrame {
  double cpu = 0;             ///< from the beginning of culling to the finished picture
  double record = 0;          ///< of that, culling and recording
  std::optional<double> gpu;  ///< of its passes; where the device has timestamps
};

/// One line of table 2.
struct ObjectFrustumRun {
  DrawnFrame grid_cell, object_frustum;
};

/// One form of a method in the view of table 2, on the CPU.
struct ObjectFrustumForm {
  std::string method;  ///< with its parameters
  Guarantee guarantee = Guarantee::conservative;
  std::uint64_t kept = 0, tested = 0, draw_calls = 0;
  std::uint64_t missing = 0;                        ///< objects that object-frustum keeps and this does not
  std::uint64_t lost_objects = 0, lost_pixels = 0;  ///< of what shows in the picture
  double cull_ms = 0;
  std::optional<DrawnFrame> drawn;
};

/// Objects kept over a grid of cells, with the whole map in sight and within the sight limit.
struct CellSize {
  std::uint32_t rows = 0, columns = 0;
  double metres = 0;  ///< the longer side of a cell
  BothMethods whole, limited;

  static double ratio(const BothMethods& kept) { return kept.grid_cell / kept.object_frustum; }
};

/// A step of figures 1 and 2, by the paper's number; no time where it is a part of another step.
struct FrameStep {
  std::string name, what;
  std::optional<BothMethods> ms;
};

/// A cell as the paper numbers it: row 1 is nearest to the viewpoint, column 1 at the left.
using NumberedCell = std::pair<std::uint32_t, std::uint32_t>;

/// BLi and BLc, ascending.
struct CellLists {
  std::vector<NumberedCell> inside, crossing;
  bool operator==(const CellLists&) const = default;
};

/// A grid that the paper draws, and what both walks make of it.
struct WalkFigure {
  std::uint32_t rows = 0, columns = 0;
  float sight_limit = 0;  ///< metres; cells are 100 m wide, the eye stands before the middle of row 1
  CellLists repaired, printed;
};

/// What the printed walk leaves out of table 2's view, over other cells, as the eye rises.
struct WalkLoss {
  float height = 0;  ///< metres over the ground
  std::uint64_t kept = 0, kept_as_printed = 0;
  std::uint64_t missing = 0;  ///< objects that the repaired walk keeps and the printed one does not
  std::uint64_t lost_objects = 0, lost_pixels = 0;  ///< of these, what shows
  std::uint64_t lost_repaired = 0;                  ///< what the repaired walk loses
};

/// A picture beside the page: SVG text, or pixels.
struct FigureFile {
  std::string name, svg;
  device::Picture pixels;
};

struct ObjectFrustumResult {
  std::string machine;
  bool drawn_by_cpu = false;  ///< the device is none but in name: llvmpipe
  std::vector<ObjectFrustumRun> runs;
  std::vector<ObjectFrustumForm> forms;
  std::vector<CellSize> cell_sizes;
  std::vector<FrameStep> steps;
  std::optional<WalkFigure> figure_4, figure_6;
  std::vector<WalkLoss> walk_losses;
  std::vector<FigureFile> files;  ///< figure 7's and the drawn frames
};

struct ObjectFrustumOptions {
  bool quick = false;
  bool pictures = false;
  std::uint32_t width = 1280, height = 720;
};

/// The cells of table 2: 5 × 5 on the square kilometre.
inline constexpr const char* kObjectFrustumCells = "rows=5&columns=5";
/// Metres: nearer than the map's edge ahead, so that it acts.
inline constexpr float kSightLimit = 480;
/// Metres over the ground, where the paper's camera stands.
inline constexpr float kEyeHeight = 8.9f;

/// The scene the paper describes: 30,000 trees on terrain of one square kilometre.
Scene object_frustum_scene();
/// Its one straight view, from the middle at 8.9 m over the ground, level; and the same without a limit.
Camera object_frustum_camera(const Scene& scene);
Camera object_frustum_camera_without_limit(const Scene& scene);

/// Objects that both methods keep over grids of several sizes: the paper's 4 × 5, 5 × 5 and 6 × 7, and square
/// cells of 46 to 250 m.
std::vector<CellSize> sweep_cell_sizes(const Scene& scene, std::uint32_t width, std::uint32_t height);

/// Figure 4 is about the distance limit, over 4 × 5 cells; figure 6 about the two angle limits, over 6 × 7.
WalkFigure walk_figure_4();
WalkFigure walk_figure_6();

/// Both walks over as many cells as figure 6 has, 6 × 7, judged at several heights of the eye. Over 5 × 5
/// each cell that the printed walk meets happens to lie on a limit.
std::vector<WalkLoss> measure_walk_losses(Scene& scene, std::uint32_t width, std::uint32_t height);

/// Measures everything; without a device nothing is drawn, and table 2 stays empty. Throws Error as Bench
/// does.
ObjectFrustumResult measure_object_frustum(device::Device* device, const ObjectFrustumOptions& options,
                                           const Progress& progress = {});

/// All of it beside what the paper prints; of an empty result, what the paper prints.
Reproduction object_frustum_reproduction(const ObjectFrustumResult& result);

/// The pictures that the page shows, into its folder. Throws Error where they cannot be written.
void write_object_frustum_pictures(const std::string& folder, const ObjectFrustumResult& result);

}  // namespace sightline::reproduce
