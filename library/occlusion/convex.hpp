#pragma once

#include <array>
#include <cstddef>

namespace sightline::occlusion {

/// A convex polygon of the image, and its plane's nearness: at + x·across + y·down.
struct Convex {
  static constexpr std::size_t kMaxEdges = 10;
  std::size_t left_edges = 0, right_edges = 0;
  std::array<float, kMaxEdges + 1> left_at, left_slope, right_at, right_slope;  // x = at + slope·y
  float top = 0, bottom = 0;  // pixel centres y with top <= y <= bottom
  float left = 0, right = 0;  // bounds of the same kind
  float at = 0, across = 0, down = 0;
};

/// Edges on the image and what lies up to `reach` beside them along x and y: pixels that a polygon leaves
/// out.
struct Bands {
  static constexpr std::size_t kMost = 16;
  std::size_t count = 0;
  std::array<float, kMost> at, slope, half;  // x = at + slope·y ± half
  std::array<float, kMost> left, right, top, bottom;
};

}  // namespace sightline::occlusion
