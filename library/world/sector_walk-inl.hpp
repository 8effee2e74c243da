// What a view sees of a sector, and the walk of its regions. Compiled into each of the few files that need
// it: who culls no instances then has it once, and within its only caller.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <numbers>
#include <span>

#include <sightline/frustum.hpp>
#include <sightline/projection.hpp>

#include "library/geometry/linear.hpp"
#include "library/world/culler_state.hpp"

namespace sightline::world {

namespace {

using namespace geometry;

std::uint8_t side_along(float normal, std::uint8_t axis, bool far) {
  return static_cast<std::uint8_t>(axis + ((normal >= 0) != far ? 3 : 0));
}

// What a view sees of a sector, but for its distances and its occluders: `to_eye` is from metres about the
// sector's origin, where `bounds` hold all that stands there, and `forward` is along what it looks.
void aim(SectorView& out, const CullView& culled, const glm::dmat4& to_eye, const Vec3& forward,
         const Box& bounds) {
  out.layers = culled.layers, out.distance_scale = culled.distance_scale;
  const glm::dmat4 clip = to_double(culled.view.view.eye_to_clip) * to_eye;
  out.planes = frustum_of(clip, forward, bounds).planes;
  for (std::size_t p = 0; p < Frustum::sides; ++p) {
    const Vec3& n = out.planes[p].normal;
    out.near_side[p] = {side_along(n.x, 0, false), side_along(n.y, 1, false), side_along(n.z, 2, false)};
    out.far_side[p] = {side_along(n.x, 0, true), side_along(n.y, 1, true), side_along(n.z, 2, true)};
  }
  out.eye = to_vec3(glm::dvec3(glm::inverse(to_eye)[3]));
  if (culled.min_area > 0) {
    const Projector projector = make_projector(culled.view.view, {});
    out.orthographic = projector.orthographic;
    out.area_scale =
        std::numbers::pi_v<float> * projector.pixels_per_metre * projector.pixels_per_metre / culled.min_area;
  }
}

// The planes among `planes` that the box crosses, or kOutside; `failed` is tried first, and remembers.
PlaneSet classify(const SectorView& view, const Box& box, PlaneSet planes, std::uint8_t& failed) {
  const auto far_enough = [&](int p, bool far) {
    const Plane& plane = view.planes[static_cast<std::size_t>(p)];
    const bool x = (plane.normal.x >= 0) != far, y = (plane.normal.y >= 0) != far,
               z = (plane.normal.z >= 0) != far;
    return signed_distance(plane, x ? box.max.x : box.min.x, y ? box.max.y : box.min.y,
                           z ? box.max.z : box.min.z) >= 0;
  };
  if ((planes >> failed & 1) && !far_enough(failed, false)) return kOutside;
  PlaneSet crossing = 0;
  for (std::uint32_t rest = planes; rest != 0; rest &= rest - 1) {
    const int p = std::countr_zero(rest);
    if (!far_enough(p, false)) {
      failed = static_cast<std::uint8_t>(p);
      return kOutside;
    }
    if (!far_enough(p, true)) crossing |= static_cast<PlaneSet>(1u << p);
  }
  return crossing;
}

using ViewPlanes = std::array<PlaneSet, kMaxViews>;

// The region tree of one sector, depth first.
class RegionWalk {
public:
  /// `sector` counts the sectors that some view may see, `failed` is the sector's.
  RegionWalk(CullerState& state, std::uint32_t sector, std::size_t views, std::uint8_t* failed) noexcept
      : state_(state), sector_(sector), views_(views), failed_(failed), map_(*state.maps[sector]) {}

  std::uint64_t run() noexcept {
    ViewPlanes all{};
    for (std::size_t v = 0; v < views_; ++v)
      all[v] = state_.views[sector_ * views_ + v].layers != 0 ? kAllPlanes : kOutside;
    visit(0, all);
    return visited_;
  }

private:
  bool narrow(const Box& box, ViewPlanes& planes, std::uint8_t* failed) const noexcept {
    bool any = false;
    for (std::size_t v = 0; v < views_; ++v) {
      if (planes[v] == kOutside) continue;
      if (planes[v] != 0) {
        planes[v] = classify(state_.views[sector_ * views_ + v], box, planes[v], failed[v]);
      }
      any = any || planes[v] != kOutside;
    }
    return any;
  }

  void visit(std::uint32_t index, ViewPlanes planes) noexcept {
    const ChunkMap::Node& node = map_.nodes()[index];
    ++visited_;
    std::uint8_t* failed = failed_ + index * kMaxViews;
    if (node.objects == 0 || !narrow(node.bounds, planes, failed)) return;
    visited_ += node.groups.size();
    find_groups(node, std::span(state_.views).subspan(sector_ * views_, views_), planes, sector_,
                state_.entries);
    if (index == 0 && map_.movers() > 0) visit(map_.mover_node(), planes);
    if (node.first_child == ChunkMap::kNone) return;
    for (std::uint32_t i = 0; i < 4; ++i) visit(node.first_child + i, planes);
  }

  CullerState& state_;
  std::uint32_t sector_;
  std::size_t views_;
  std::uint8_t* failed_;
  const ChunkMap& map_;
  std::uint64_t visited_ = 0;
};

}  // namespace

}  // namespace sightline::world
