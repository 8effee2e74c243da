// What occluders hide in truth: their depth in double precision at every pixel's centre, or at samples
// anywhere in it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sightline/types.hpp>
#include <sightline/view.hpp>

namespace sightline::bench {

/// Of a perspective view whose near plane is that far from the eye. One sample a pixel is its centre, more
/// lie anywhere in it, elsewhere by `seed`. Triangles cover what lies on their border.
class OccluderTruth {
public:
  OccluderTruth(const View& view, float near_plane, std::uint32_t samples = 1, std::uint64_t seed = 1);

  /// Three indices a triangle; `two_sided`: not from the front alone.
  void draw(std::span<const Vec3> positions, std::span<const std::uint32_t> indices, bool two_sided);
  /// Whether some sample within the box's rectangle is farther than the box's nearest point.
  [[nodiscard]] bool sees(const Box& box) const;
  /// 1 / w of the nearest surface at a pixel's first sample; 0 where there is none.
  [[nodiscard]] double nearness(std::uint32_t x, std::uint32_t y) const {
    return depth_[(std::size_t{y} * width_ + x) * samples_];
  }

private:
  struct Place {
    double x, y;
  };
  [[nodiscard]] Place place(std::uint32_t x, std::uint32_t y, std::uint32_t sample) const;

  std::uint32_t width_, height_, samples_;
  double clip_[3][4];  ///< rows: pixels times w across and down, w
  double least_w_;     ///< of the near plane
  std::vector<float> offsets_;
  std::vector<double> depth_;
};

}  // namespace sightline::bench
