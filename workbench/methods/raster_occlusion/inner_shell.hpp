// Simpler occluders for meshes of many triangles.
#pragma once

#include <optional>
#include <span>

#include <sightline/occlusion.hpp>

namespace sightline::methods {

/// The mesh as an occluder. Where it is closed and convex and has many triangles, 80 triangles between points
/// of it take its place: they lie inside the solid, so whatever they hide it hides.
OccluderMesh simple_occluder(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

/// A ball inside the mesh, where it is closed and convex and the ball fills most of it: every point within
/// `radius` of `centre` is solid.
std::optional<Sphere> inner_ball(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

}  // namespace sightline::methods
