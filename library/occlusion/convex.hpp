#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace sightline::occlusion {

/// A convex polygon of the image, and its plane's nearness: at + x·across + y·down.
struct Convex {
  static constexpr std::size_t kMaxEdges = 10;
  std::size_t edges = 0;
  /// x = at + slope·y; an edge bounds one side, on the other it lies at infinity.
  std::array<float, kMaxEdges> slope, left_at, right_at;
  /// Where edges may go straight on, rounding would let the line of a short one cut a long one: then each
  /// bounds the lines from..to alone.
  bool by_lines = false;
  std::array<float, kMaxEdges> from, to;
  bool has_left = false, has_right = false;  // edges
  float top = 0, bottom = 0;                 // pixel centres y with top <= y <= bottom
  float left = 0, right = 0;                 // bounds of the same kind
  float at = 0, across = 0, down = 0;

  void add_edge(bool on_right, float edge_at, float edge_slope) {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    slope[edges] = edge_slope;
    left_at[edges] = on_right ? -kFar : edge_at;
    right_at[edges++] = on_right ? edge_at : kFar;
    (on_right ? has_right : has_left) = true;
  }
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
