// Verification: methods against the oracle, view by view.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sightline/view.hpp>
#include <sightline/workbench/progress.hpp>

#include "workbench/measure/bench.hpp"

namespace sightline::measure {

/// One object that a method dropped although it has a visible pixel.
struct LostObject {
  std::size_t view = 0;  ///< index of the camera
  Camera camera;
  std::uint32_t width = 0, height = 0;
  ObjectId object = kNoObject;   ///< kNoObject: none was lost, but pixels of the picture differ
  std::uint64_t pixels = 0;      ///< lost in this view, over all its lost objects; or that differ
  WorldPoint origin{};           ///< what the camera counts from
  std::size_t moves = 0;         ///< how often objects had moved by then
  std::optional<Camera> before;  ///< on a device: what was drawn just before
};

struct MethodVerdict {
  std::string method;
  Guarantee guarantee = Guarantee::exact;
  /// It speaks of pixel centres, and other places were judged: what was lost there is only reported.
  bool of_centres = false;
  std::uint64_t kept = 0, visible = 0;  ///< objects, summed over the views
  std::uint64_t lost_objects = 0, lost_pixels = 0, excess_objects = 0;
  std::uint64_t different_pixels = 0;  ///< on a device: that differ from the picture of all it could draw
  std::size_t views_with_loss = 0;
  std::vector<LostObject>
      examples;  ///< from the first views that break the guarantee, one for approximate methods

  /// False where an exact or conservative method lost something, or an exact one drew another picture; an
  /// approximate one only reports, as does one that was judged where it promises nothing.
  [[nodiscard]] bool holds() const noexcept {
    return of_centres || guarantee == Guarantee::approximate ||
           (lost_objects == 0 && (guarantee != Guarantee::exact || different_pixels == 0));
  }
};

struct Verification {
  std::string scene, device = "cpu";
  RasterState raster_state = RasterState::materials;  ///< that "exact" speaks of
  std::size_t views = 0;
  std::vector<MethodVerdict> methods;
  [[nodiscard]] bool passed() const noexcept;
  /// Whether a device drew the frames, so that pictures were compared.
  [[nodiscard]] bool drawn() const noexcept { return device != "cpu"; }
};

/// Culls every view with every method and holds the answers against the oracle. On a device each view is a
/// camera cut for every method, and is drawn once more after it, so that a settled frame is examined, too,
/// and the pictures are compared. `moving` is the share of objects that move before every look. Throws Error
/// for a camera that makes no view, and for a method that names an object twice or one that does not exist.
Verification verify(Bench& bench, std::span<const Camera> cameras, std::uint32_t width, std::uint32_t height,
                    double moving = 0, const Progress& progress = {});

/// A verification of no views yet, and one look of one subject, which is added to its verdict.
Verification start_verification(const Bench& bench);
void examine(Bench& bench, Subject& subject, const View& view, const LostObject& where,
             MethodVerdict& verdict);

/// A sentence that names method, view and object, with every number of the view.
std::string describe(const MethodVerdict& verdict, const LostObject& lost);

}  // namespace sightline::measure
