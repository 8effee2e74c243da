// Simpler occluders for meshes of many triangles.
#pragma once

#include <span>

#include <sightline/occlusion.hpp>

namespace sightline::methods {

/// The mesh as an occluder. Where it is closed and convex and has many triangles, 80 triangles between points
/// of it take its place: they lie inside the solid, so whatever they hide it hides.
OccluderMesh simple_occluder(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

}  // namespace sightline::methods
