// Whether a triangle reaches into a box.
#pragma once

#include <array>

#include <sightline/types.hpp>

namespace sightline::partition {

/// Separating axes (Akenine-Möller 2001) in double precision with room for rounding: false is certain, so
/// that every point of the triangle lies in a box that it is said to overlap. Borders count.
bool overlaps(const std::array<Vec3, 3>& triangle, const Box& box) noexcept;

}  // namespace sightline::partition
