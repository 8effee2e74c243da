// From visible objects to draw commands, in the order of a frame: state by state, what is not blended front
// to back with one instanced call a mesh; then transparent back to front, one call a run of equal meshes (Le
// Hoang Minh et al. 2022, section 2).
#pragma once

#include <array>
#include <span>
#include <vector>

#include <sightline/view.hpp>
#include <sightline/workbench/frame.hpp>
#include <sightline/workbench/parameters.hpp>

#include "workbench/submission/draw_state.hpp"

namespace sightline::submission {

/// What a draw call draws: all visible objects of a mesh, instanced, or one object.
enum class CallOf : std::uint8_t { mesh, object };

/// The parameter `submission`, for the tables of methods that have it.
inline constexpr ParameterInfo kSubmissionParameter{
    "submission",       "a draw call a mesh, instanced, or one an object", "instanced", 0, 0, false,
    "instanced|objects"};
CallOf call_from(const Parameters& parameters) noexcept;

/// Scratch of one scene's draw lists; build() allocates nothing once it has seen as many objects.
class DrawList {
public:
  explicit DrawList(const Scene& scene, CallOf call = CallOf::mesh);

  /// Reorders frame.visible, fills frame.draws, and counts calls and triangles in frame.stats.
  void build(const Scene& scene, const View& view, Frame& frame) noexcept;

private:
  void draw_by_mesh(const Scene& scene, std::span<const std::uint64_t> near_first, std::uint32_t first,
                    Frame& frame) noexcept;
  void draw_in_runs(const Scene& scene, std::uint32_t first, Frame& frame) const noexcept;
  static void draw_one_by_one(const Scene& scene, std::span<const std::uint64_t> keys, std::uint32_t first,
                              Frame& frame) noexcept;

  CallOf call_;
  std::vector<DrawState> states_;  // by object
  // By state; depth in the high half, id in the low: equal depths still have one order.
  std::array<std::vector<std::uint64_t>, kDrawStates> keys_;
  std::vector<std::uint64_t> scratch_;
  std::vector<std::uint32_t> instances_;  // by mesh, all 0 between builds
  std::vector<std::uint32_t> touched_;    // meshes of this frame, nearest first
};

}  // namespace sightline::submission
