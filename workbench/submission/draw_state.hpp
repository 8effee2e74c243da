// How an object's triangles go through a rasteriser.
#pragma once

#include <sightline/workbench/scene.hpp>

namespace sightline::submission {

/// In the order in which they are drawn. The first three are solid: they hide what is behind them, and are
/// what occlusion tests look at.
enum class DrawState : std::uint8_t {
  both_sides,
  front_faces,   ///< those that run clockwise as seen are culled
  turned_faces,  ///< front faces that a mirroring transform turns: those that run counter-clockwise are
  cut_out,       ///< tested fragment by fragment
  blended,       ///< transparent, far to near
};
inline constexpr std::size_t kDrawStates = 5;

inline constexpr bool is_solid(DrawState state) noexcept {
  return state < DrawState::cut_out;
}

inline DrawState draw_state(const Scene& scene, ObjectId object) noexcept {
  switch (scene.surface[object]) {
    case Surface::transparent:
      return DrawState::blended;
    case Surface::cut_out:
      return DrawState::cut_out;
    case Surface::opaque:
      break;
  }
  if (scene.sides[object] == Sides::both) return DrawState::both_sides;
  return mirrors(scene.transform[object]) ? DrawState::turned_faces : DrawState::front_faces;
}

}  // namespace sightline::submission
