// Occluders of a scene's meshes, and the oracle's word on each.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/occluder.hpp>
#include <sightline/workbench/progress.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline::measure {

/// What occludes in place of a mesh, of which these sides are drawn.
struct MadeOccluder {
  std::uint32_t mesh = 0;
  Sides sides = Sides::both;
  std::size_t objects = 0;    ///< opaque ones that show it so
  std::size_t triangles = 0;  ///< of the mesh
  Occluder occluder;
};

/// One for each mesh and sides that an opaque object shows; what is cut out or transparent never occludes.
/// Throws Error for meshes that the library refuses.
std::vector<MadeOccluder> make_occluders(const Scene& scene, const OccluderOptions& options,
                                         const Progress& progress = {});

/// The scene with each opaque object's occluder in its place, without objects that have none; triangles of
/// either sides are objects of their own, and so are boxes where there is no triangle.
Scene occluder_scene(const Scene& scene, const std::vector<MadeOccluder>& occluders);

/// What an occluder's triangles and its boxes cover, drawn into an occlusion buffer, and what the mesh does,
/// by rays. Pixels are counted over all views.
struct OccluderEvidence {
  std::uint64_t mesh_pixels = 0, covered_pixels = 0, box_pixels = 0;
  /// Where something was covered that the mesh does not cover as near, in double precision too.
  std::uint64_t wrong_pixels = 0;
  [[nodiscard]] double covered() const noexcept {
    return mesh_pixels == 0 ? 0 : static_cast<double>(covered_pixels) / static_cast<double>(mesh_pixels);
  }
};

/// Looks at the mesh from all around it, near and far, in perspective and without; from within it too where
/// the occluder has nothing solid. `pixels` is the side of a view. Same arguments, same views.
OccluderEvidence examine(const Scene& scene, const MadeOccluder& made, std::size_t views,
                         std::uint32_t pixels);

}  // namespace sightline::measure
