// The yardstick of flat frustum culling: one box after another, without a branch.
#pragma once

#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>

namespace sightline::benchmarks {

/// As cull_boxes, in scalar code.
std::size_t cull_boxes_scalar(const Frustum& frustum, const Boxes& boxes,
                              std::span<ObjectId> visible) noexcept;

}  // namespace sightline::benchmarks
