// What objects look like, as far as culling cares: the checks, and the raster state.
#pragma once

#include <sightline/workbench/scene.hpp>

namespace sightline::scene {

/// The sides drawn of a material's triangles in a raster state.
Sides drawn_sides(Sides of_material, RasterState state) noexcept;

/// Throws Error unless materials, alpha images, texture coordinates and the origin fit the scene.
void check_materials(const Scene& scene);

}  // namespace sightline::scene
