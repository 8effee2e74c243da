// The rays of a view, one through each pixel centre, from the near to the far plane. In double precision,
// from the inverted matrices alone, so that every projection works and none of the culling code is trusted.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

#include <sightline/view.hpp>

namespace sightline::oracle {

/// The part of a pixel's line of sight that clip depth 0 … 1 leaves: origin + t·direction, 0 <= t <= length.
struct PixelRay {
  glm::dvec3 origin;     ///< on the near plane
  glm::dvec3 direction;  ///< unit
  double length = 0;     ///< metres to the far plane; +infinity where there is none
};

class PixelRays {
public:
  explicit PixelRays(const View& view);
  /// Through the centre of pixel (x, y), row 0 at the top.
  [[nodiscard]] PixelRay through(std::uint32_t x, std::uint32_t y) const noexcept;
  /// Metres along that ray to what lies at a clip depth.
  [[nodiscard]] double distance(std::uint32_t x, std::uint32_t y, double depth) const noexcept;

private:
  [[nodiscard]] glm::dvec4 eye_point(std::uint32_t x, std::uint32_t y, double depth) const noexcept;
  glm::dmat4 clip_to_world_;
  glm::dmat3 eye_to_world_;
  glm::dmat4 clip_to_eye_;
  double near_depth_ = 0, far_depth_ = 1;
  double width_, height_;
};

}  // namespace sightline::oracle
