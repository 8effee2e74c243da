// What occludes in place of a mesh: simpler, and wholly inside it.
#pragma once

#include <optional>
#include <span>

#include <sightline/occluder.hpp>
#include <sightline/workbench/affine.hpp>

namespace sightline::methods {

/// Of a mesh that is closed and convex and has many triangles, 80 triangles between points of it: they lie
/// inside the solid, so whatever they hide it hides. Nothing of other meshes, nor of one whose front alone is
/// drawn and that does not look outwards everywhere.
std::optional<OccluderMesh> occluder_proxy(std::span<const Vec3> positions,
                                           std::span<const std::uint32_t> indices, Sides sides = Sides::both);

/// A sphere inside the mesh, where it is closed and convex and the sphere fills most of it: every point
/// within `radius` of `centre` is solid. The same of sides.
std::optional<Sphere> inner_sphere(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                                   Sides sides = Sides::both);

/// A sphere inside the image of a solid sphere under the transform; its radius is 0 where none is certain.
Sphere sphere_inside(const Affine& transform, const Sphere& sphere) noexcept;

}  // namespace sightline::methods
