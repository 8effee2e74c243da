// Every way that Embree has of casting rays, each at its best: rays stand ready in the layout that the call
// wants, neighbours side by side, and a cast resets no more than what the last one wrote.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include <sightline/rays.hpp>

#include "embree_boxes.hpp"
#include "library/rays/ray_hits.hpp"

namespace sightline::benchmarks {

/// What Embree calls for each box it comes to: the slab test with all rays of a packet, in SIMD.
RTCIntersectFunctionN embree_callback();

/// Casts rays that were laid out, and writes what they met by their places in the span they came from.
using EmbreeCast = std::function<void(const EmbreeBoxes& boxes, rays::RayHits& hits)>;

/// What is cast: the rays in the order in which their indices stand in `order`. All of it stays where it is.
struct EmbreeInput {
  std::span<const Ray> rays;
  std::span<const PreparedRay> prepared;
  std::span<const std::uint32_t> order;
  bool coherent;
};

struct EmbreeForm {
  const char* name;
  EmbreeCast (*lay_out)(const EmbreeInput& input);
};

/// rtcIntersect1, 4, 8 and 16, and the streams 1M and NM.
std::span<const EmbreeForm> embree_forms();

}  // namespace sightline::benchmarks
