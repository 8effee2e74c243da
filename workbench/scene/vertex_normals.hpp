// Normals of meshes that come without.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/types.hpp>

namespace sightline::scene {

/// Gives it unit length; false, and nothing done, where it has no direction.
bool normalise(std::array<double, 3>& v) noexcept;

/// One a position, of unit length: the sum of those of the triangles around it, weighted by area; up where
/// there are none. Triangles with an index out of range count for nothing.
std::vector<Vec3> vertex_normals(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

}  // namespace sightline::scene
