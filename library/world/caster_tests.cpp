// Casters in a cull: of chunks and objects, whether they reach into the planes around all that can throw a
// shadow, and whether a receiver lies behind them.
#include "library/world/shadow_casters.hpp"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/world/caster_tests.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/geometry/error_bounds.hpp"
#include "library/world/culler_state.hpp"
#include "library/world/world_cull-inl.hpp"

#ifndef SIGHTLINE_LIBRARY_WORLD_CASTER_TESTS
#define SIGHTLINE_LIBRARY_WORLD_CASTER_TESTS
namespace sightline::world {

/// A view's casters as a sector sees them.
struct CasterView {
  struct Sided {
    Plane plane;
    std::array<std::uint8_t, 3> near_side, far_side;  // as SectorView has them
  };
  std::array<Sided, Casters::kMostPlanes> planes;
  std::size_t count = 0;
  const occlusion::DepthTiles* mask = nullptr;  // null: shadows may fall anywhere
  occlusion::EyeProjection projection;          // of the mask
  const ColumnTests* columns = nullptr;         // the world's own; null: it has none
};

}  // namespace sightline::world
#endif

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

ColumnBits caster_chunks(const ChunkMap::Group& group, const CasterView& casters) {
  const F f;
  const Sides sides = sides_of(group);
  std::uint32_t outside = 0, crossing = 0;
  for (std::size_t p = 0; p < casters.count; ++p) {
    const CasterView::Sided& at = casters.planes[p];
    for (std::size_t i = 0; i < kGroup; i += hn::Lanes(f)) {
      outside |= bits_of(f, behind(at.plane, sides, at.near_side, i)) << i;
      crossing |= bits_of(f, behind(at.plane, sides, at.far_side, i)) << i;
    }
  }
  return {~outside, ~(outside | crossing)};
}

void caster_objects(const ChunkMap::ChunkView& chunk, const CasterView& casters, ObjectBits& seen) {
  for (std::size_t p = 0; p < casters.count; ++p)
    drop_behind(chunk, casters.planes[p].plane, casters.planes[p].near_side, seen);
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {
HWY_EXPORT(caster_chunks);
HWY_EXPORT(caster_objects);

namespace {

ColumnBits chunks_that_cast(const ChunkMap& map, std::uint32_t number, const SectorView& view) {
  const CasterView& casters = *view.casters;
  ColumnBits out{~0u, ~0u};
  if (casters.columns) out = casters.columns->chunks(map, number, view);
  const ChunkMap::Group& group = map.groups()[number];
  if (casters.count > 0) {
    const ColumnBits by_planes = HWY_DYNAMIC_DISPATCH(caster_chunks)(group, casters);
    out.some &= by_planes.some, out.all &= by_planes.all;
  }
  if (!casters.mask || out.some == 0) return out;
  std::array<std::uint8_t, ChunkMap::kGroupCapacity> seen;
  occlusion::query_boxes(*casters.mask, casters.projection, boxes_of(group), seen.data());
  for (std::uint32_t i = 0; i < group.count; ++i) out.some &= ~(std::uint32_t{seen[i] == 0} << i);
  out.all = 0;
  return out;
}

ObjectBits objects_that_cast(const ChunkMap& map, const ChunkMap::Group& group,
                             const ChunkMap::ChunkView& chunk, const SectorView& view) {
  const CasterView& casters = *view.casters;
  ObjectBits seen{{~std::uint64_t{0}, ~std::uint64_t{0}}};
  if (casters.columns) seen = casters.columns->objects(map, group, chunk, view);
  if (casters.count > 0) HWY_DYNAMIC_DISPATCH(caster_objects)(chunk, casters, seen);
  if (!casters.mask) return seen;
  std::array<std::uint8_t, ChunkMap::kCapacity> cast;
  occlusion::query_boxes(*casters.mask, casters.projection, chunk.boxes(), cast.data());
  for (std::uint32_t i = 0; i < chunk.count; ++i)
    if (cast[i] == 0) seen.drop(i);
  return seen;
}

constexpr ColumnTests kCasterTests{chunks_that_cast, objects_that_cast};

// A plane about a sector, moved outwards by what rounding it and evaluating it lose within the sector.
CasterView::Sided about_sector(const WidePlane& plane, const glm::dvec3& offset, const Vec3& reach) {
  const glm::dvec3& n = plane.normal;
  const double distance = glm::dot(n, offset) + plane.distance;
  const double size = glm::dot(glm::abs(n), glm::dvec3(reach.x, reach.y, reach.z)) + std::fabs(distance);
  CasterView::Sided out;
  out.plane = {geometry::to_vec3(n), static_cast<float>(distance + geometry::kPlaneRounding * size)};
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    const bool rises = n[axis] >= 0;
    out.near_side[axis] = static_cast<std::uint8_t>(axis + (rises ? 3 : 0));
    out.far_side[axis] = static_cast<std::uint8_t>(axis + (rises ? 0 : 3));
  }
  return out;
}

// Those of the planes that a sector's bounds are not wholly before.
void set_planes(const Casters& casters, const glm::dvec3& offset, const Box& bounds, CasterView& out) {
  out.count = 0;
  for (const WidePlane& plane : std::span(casters.planes).first(casters.plane_count)) {
    const CasterView::Sided at = about_sector(plane, offset, geometry::largest(bounds));
    const std::array<float, 6> sides{bounds.min.x, bounds.min.y, bounds.min.z,
                                     bounds.max.x, bounds.max.y, bounds.max.z};
    if (signed_distance(at.plane, sides[at.far_side[0]], sides[at.far_side[1]], sides[at.far_side[2]]) < 0)
      out.planes[out.count++] = at;
  }
}

class Preparation final : public Casting {
public:
  const ColumnTests* prepare(CullerState& state, std::span<const CullView> views,
                             const DifferentViews& different) override {
    views_.reserve(state.world->sectors.size() * different.count);
    views_.resize(state.maps.size() * different.count);
    for (std::size_t s = 0; s < state.maps.size(); ++s) {
      for (std::size_t d = 0; d < different.count; ++d) {
        const std::size_t at = s * different.count + d;
        CasterView& out = views_[at];
        out.count = 0, out.mask = nullptr, out.columns = state.world->column_tests;
        state.views[at].casters = &out;
        if (const ShadowCasters* given = views[different.first[d]].casters)
          set(ShadowAccess::casters(*given), state.origins[s], state.maps[s]->nodes()[0].bounds, out);
      }
    }
    return &kCasterTests;
  }

private:
  static void set(const Casters& casters, const WorldPoint& origin, const Box& bounds, CasterView& out) {
    const WorldPoint& about = casters.shadow.origin;
    if (SIGHTLINE_MUTANT(casters_by_frustum)) return;
    set_planes(casters, {origin.x - about.x, origin.y - about.y, origin.z - about.z}, bounds, out);
    if (!casters.receives) return;
    out.mask = &OcclusionAccess::tiles(casters.mask);
    out.projection = occlusion::eye_projection(out.mask->view, origin, out.mask->scale);
  }

  std::vector<CasterView> views_;
};

Status check_casters(const Casters& casters, const WorldView& view, std::size_t index) noexcept {
  if (!casters.begun) return {StatusCode::stale_buffer, "cull: a view's casters were never begun", index};
  if (casters.shadow != view)
    return {StatusCode::stale_buffer, "cull: casters were begun with another view than they stand beside",
            index};
  return {};
}

std::unique_ptr<Casting> make_casting() {
  return std::make_unique<Preparation>();
}

}  // namespace

constinit const CasterTools kCasterTools{check_casters, make_casting};

}  // namespace sightline::world
#endif
