// Shadow caster culling against lit pictures: views with a light each, drawn with all casters and with those
// that sightline::ShadowCasters keeps.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <sightline/shadows.hpp>
#include <sightline/view.hpp>
#include <sightline/workbench/progress.hpp>

#include "workbench/oracle/lit_pictures.hpp"

namespace sightline::measure {

struct CasterOptions {
  LightKind light = LightKind::directional;  ///< directional or spot
  std::uint32_t width = 160, height = 120;   ///< of the camera's pictures
  std::uint32_t map = 1024;                  ///< texels across the shadow map
  float distance = 150;                      ///< metres: how far the camera sees, and shadows are drawn
  oracle::ShadowLookup lookup{};
  std::uint64_t seed = 1;  ///< of the lights
};

struct CasterEvidence {
  std::size_t views = 0, different_views = 0;
  std::uint64_t in_light = 0;    ///< objects in the lights' frustums, summed over the views
  std::uint64_t towards_it = 0;  ///< of these, those that reach into what the camera sees, extruded
  std::uint64_t kept = 0;        ///< and of these, those whose shadow can fall on something visible
  std::uint64_t pixels = 0, shaded_pixels = 0, different_pixels = 0;  ///< shaded: not wholly lit
  std::optional<std::size_t> first_different;                         ///< the index of a camera
  device::Picture picture;  ///< the last view's, of all casters, under a sky; every alpha 255
};

/// Culls each camera by frustum and occluders, then its light's casters by what is left. A sun stands
/// anywhere over the ground, a spot near the eye and shines at something before it. Cameras beyond what
/// shadow views take are not counted. Throws Error for a light that is a point.
CasterEvidence prove_casters(device::Renderer& renderer, std::span<const Camera> cameras,
                             const CasterOptions& options, const Progress& progress = {});

}  // namespace sightline::measure
