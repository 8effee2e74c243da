// Flat frustum culling: many boxes or spheres in structure of arrays against one frustum, in SIMD with
// run-time dispatch. Order and answer are the same for every SIMD width.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>
#include <sightline/types.hpp>

namespace sightline {

/// Room that an output of the functions below needs beyond the input's count.
inline constexpr std::size_t kCullPadding = 64;

/// Writes the indices of the boxes that overlap the frustum (as `overlaps` says), in ascending order; returns
/// how many. `visible` has room for boxes.count + kCullPadding; what stands behind the returned count is
/// undefined.
std::size_t cull_boxes(const Frustum& frustum, const BoxSpan& boxes, std::span<ObjectId> visible) noexcept;

/// The same for spheres.
std::size_t cull_spheres(const Frustum& frustum, const SphereSpan& spheres,
                         std::span<ObjectId> visible) noexcept;

}  // namespace sightline
