// The peer of flat culling: the loop that somebody writes by hand for the one processor at hand.
#pragma once

#include <span>

#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>

namespace sightline::benchmarks {

/// How the loop is written.
struct PlainLoop {
  const char* name;
  /// As cull_boxes, but with fused operations: a box within rounding of a plane may be judged otherwise.
  std::size_t (*cull)(const Frustum& frustum, const Boxes& boxes, std::span<ObjectId> visible) noexcept;
};

/// None where this processor has no AVX-512, or it was not compiled for.
std::span<const PlainLoop> plain_loops() noexcept;

}  // namespace sightline::benchmarks
