// Where a scene's positions count from: 0, unless that is so far away that floats are too coarse.
#pragma once

#include <sightline/types.hpp>

namespace sightline::scene {

/// The centre of the extent, rounded to 256 m, where it lies more than 100 km from 0, or more than a
/// kilometre and 16 times the extent's longest side; otherwise 0.
WorldPoint far_origin(const Box& extent) noexcept;

/// A point of the world as the scene has it, and the reverse.
Vec3 to_scene(const WorldPoint& origin, const WorldPoint& point) noexcept;
WorldPoint to_world(const WorldPoint& origin, const Vec3& point) noexcept;

}  // namespace sightline::scene
