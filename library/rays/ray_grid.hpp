// The rays of a view: a uniform grid over the viewport (Ye et al. 2023, sections 2.3 and 4), or through any
// point of it.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

#include <sightline/rays.hpp>
#include <sightline/view.hpp>

namespace sightline::rays {

/// Lines of sight out of the view's inverse matrices, in double precision, rounded once: any projection
/// works.
class ViewRays {
public:
  /// The view has passed check().
  explicit ViewRays(const View& view) noexcept;
  /// From the near plane to the far plane through the point (x, y) of the image in pixels, (0, 0) the top
  /// left corner; of unit length. Where there is no far plane, max_distance is the largest float.
  [[nodiscard]] Ray through(double x, double y) const noexcept;

private:
  glm::dmat4 clip_to_eye_, eye_to_world_;
  double near_depth_ = 0, far_depth_ = 1, width_, height_;
};

/// columns × rows rays, row 0 at the top. Plain arrays, so that a GPU or a web page can share them.
struct RayGrid {
  std::uint32_t columns = 0, rows = 0;
  std::vector<Ray> rays;
  std::vector<PreparedRay> prepared;  ///< the same, as the slab test wants them
  std::vector<std::uint32_t> order;   ///< all rays, 4 × 4 neighbours after one another

  [[nodiscard]] std::size_t size() const noexcept { return rays.size(); }
  /// Rays through the middles of columns × rows equal parts of the viewport. Allocates only to grow.
  void make(const View& view, std::uint32_t columns, std::uint32_t rows);
};

}  // namespace sightline::rays
