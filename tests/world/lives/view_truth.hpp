// What a view sees of boxes, in double precision and from its matrices alone, and how far the library may be
// off.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/instances.hpp>
#include <sightline/world.hpp>

#include "library/geometry/linear.hpp"

namespace sightline::lives {

enum class Verdict : std::uint8_t { seen, unseen, either };

/// A view in the space of the boxes that it looks at: the world's, or that of a world which an instance
/// places.
class ViewTruth {
public:
  explicit ViewTruth(const WorldView& view);
  ViewTruth(const WorldView& view, const InstancePlacement& placement);

  /// Of the box's best corner from the worst plane, in the view's metres; negative outside.
  [[nodiscard]] double depth(const WorldBox& box) const;
  /// From the eye to the box's middle, in the box's metres.
  [[nodiscard]] double distance(const WorldBox& box) const;
  /// Diameter of the ball around the box.
  [[nodiscard]] double pixels(const WorldBox& box) const;
  /// By what share pixels() may differ from what the library finds; 1 where nothing can be said.
  [[nodiscard]] double pixels_doubt(const WorldBox& box) const;

  /// `largest`: the size of the largest box that shares planes' rounding with this one.
  [[nodiscard]] Verdict in_frustum(const WorldBox& box, double largest) const;
  [[nodiscard]] Verdict in_range(const WorldBox& box, const DistanceRange& range, float scale) const;

private:
  View view_;
  std::vector<glm::dvec4> planes_;
  WorldPoint about_;  // of planes and eye
  glm::dvec3 eye_;
  double eye_away_;  // from the view's origin
  double scale_ = 1;
  bool placed_ = false;
};

}  // namespace sightline::lives
