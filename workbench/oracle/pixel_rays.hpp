// The rays of a view, one through each pixel's centre or another place in it, from the near to the far plane.
// In double precision, from the inverted matrices alone, so that every projection works and none of the
// culling code is trusted.
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
  /// Sample 0: pixel centres; 1 and on: a place anywhere in each pixel, drawn at random by sample and pixel,
  /// the same whenever it is asked for.
  explicit PixelRays(const View& view, std::uint32_t sample = 0);
  /// Through the sample of pixel (x, y), row 0 at the top.
  [[nodiscard]] PixelRay through(std::uint32_t x, std::uint32_t y) const noexcept;
  /// Metres along that ray to what lies at a clip depth.
  [[nodiscard]] double distance(std::uint32_t x, std::uint32_t y, double depth) const noexcept;

private:
  [[nodiscard]] glm::dvec2 place(std::uint32_t x, std::uint32_t y) const noexcept;
  [[nodiscard]] glm::dvec4 eye_point(const glm::dvec2& at, double depth) const noexcept;
  glm::dmat4 clip_to_world_;
  glm::dmat3 eye_to_world_;
  glm::dmat4 clip_to_eye_;
  double near_depth_ = 0, far_depth_ = 1;
  double width_, height_;
  std::uint32_t sample_;
};

}  // namespace sightline::oracle
