// How far from the light receivers lie, over the image of a shadow view.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <vector>

#include "library/world/shadow_casters.hpp"

namespace sightline::world {

/// Filled in double precision: what is added covers all pixels that it touches, and the filter's texels
/// around.
class ReceiverMask {
public:
  /// An empty one over `nearness`, which it sizes.
  ReceiverMask(const Casters& casters, std::vector<float>& nearness);

  /// About the shadow view's origin; it grows by the filter's metres.
  void add_box(const glm::dvec3& low, const glm::dvec3& high);
  /// What lies between eight points.
  void add_points(const std::array<glm::dvec3, 8>& points);
  /// Where receivers are known in two ways, they lie no farther than either says.
  void keep_nearer(const std::vector<float>& other);
  /// As if what lies behind the farthest receiver were hidden.
  void write(OcclusionBuffer& buffer) const;

private:
  void fill(const std::array<glm::dvec3, 8>& points);

  View view_;  // the shadow view's, of fewer pixels
  WorldPoint origin_;
  bool parallel_;
  glm::dvec4 x_, y_, w_, depth_;  // · (p, 1)
  double metres_, margin_x_, margin_y_;
  std::vector<float>& nearness_;
};

}  // namespace sightline::world
