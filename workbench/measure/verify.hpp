// Verification: methods against the item buffer, view by view.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sightline/view.hpp>
#include <sightline/workbench/method.hpp>
#include <sightline/workbench/progress.hpp>

#include "workbench/measure/contestant.hpp"

namespace sightline::measure {

/// One object that a method dropped although it has a visible pixel.
struct LostObject {
  std::size_t view = 0;  ///< index of the camera
  Camera camera;
  std::uint32_t width = 0, height = 0;
  ObjectId object = kNoObject;
  std::uint64_t pixels = 0;  ///< lost in this view, over all its lost objects
};

struct MethodVerdict {
  std::string method;
  Guarantee guarantee = Guarantee::exact;
  std::uint64_t kept = 0, visible = 0;  ///< objects, summed over the views
  std::uint64_t lost_objects = 0, lost_pixels = 0, excess_objects = 0;
  std::size_t views_with_loss = 0;
  std::vector<LostObject> examples;  ///< from the first views with a loss, one for approximate methods

  /// False where an exact or conservative method lost something; an approximate one only reports.
  [[nodiscard]] bool holds() const noexcept {
    return lost_objects == 0 || guarantee == Guarantee::approximate;
  }
};

struct Verification {
  std::string scene;
  std::size_t views = 0;
  std::vector<MethodVerdict> methods;
  [[nodiscard]] bool passed() const noexcept;
};

/// Culls every view with every method and compares with the judge. Throws Error for a camera that makes no
/// view, and for a method that names an object twice or one that does not exist.
Verification verify(const Scene& scene, std::span<const Contestant> contestants,
                    std::span<const Camera> cameras, std::uint32_t width, std::uint32_t height,
                    const Progress& progress = {});

/// A sentence that names method, view and object, with every number of the view.
std::string describe(const MethodVerdict& verdict, const LostObject& lost);

}  // namespace sightline::measure
