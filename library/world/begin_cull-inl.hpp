// What any cull of a world begins with: whether its views are sound, which of them differ, and the groups
// that they may see. Compiled into each of the few files that need it, so that who culls in one way has it
// once, and within its only caller.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <span>

#include <sightline/occlusion.hpp>

#include "library/geometry/linear.hpp"
#include "library/geometry/mutant.h"
#include "library/world/culler_state.hpp"
#include "library/world/sector_walk-inl.hpp"

namespace sightline::world {

namespace {

Status check_view(const CullView& view, std::size_t index, std::size_t views) noexcept {
  if (const Status sound = check(view.view); !sound) return {StatusCode::bad_view, sound.message(), index};
  if (!(view.min_area >= 0) || !std::isfinite(view.min_area))
    return {StatusCode::bad_argument, "cull: a view's min_area is negative or not finite", index};
  if (!(view.distance_scale > 0) || !std::isfinite(view.distance_scale))
    return {StatusCode::bad_argument, "cull: a view's distance_scale is not above 0 or not finite", index};
  if (view.distance_view != kOwnView && view.distance_view >= views)
    return {StatusCode::bad_argument, "cull: a view's distance_view is none of the views", index};
  if (view.casters) {
    const Casters& casters = ShadowAccess::casters(*view.casters);
    if (const Status fits = casters.tools->check(casters, view.view, index); !fits) return fits;
  }
  if (!view.occlusion) return {};
  if (!view.occlusion->begun())
    return {StatusCode::stale_buffer, "cull: a view's occlusion buffer was never begun", index};
  if (view.occlusion->view() != view.view)
    return {StatusCode::stale_buffer,
            "cull: an occlusion buffer was begun with another view than it stands beside", index};
  return {};
}

// Whether each view is one that can be culled; of the jobs and zones, too.
Status check_views(std::span<const CullView> views, const JobSystem& jobs, const CullZones& zones) noexcept {
  if (views.empty() || views.size() > kMaxViews)
    return {StatusCode::bad_argument, "cull: expected 1 to 8 views", views.size()};
  if (jobs.threads < 1 || jobs.threads > kMaxJobs)
    return {StatusCode::bad_argument, "cull: expected 1 to 64 jobs"};
  if ((zones.begin == nullptr) != (zones.end == nullptr))
    return {StatusCode::bad_argument, "cull: a zone's begin or end is null, expected both or none"};
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (const Status sound = check_view(views[v], v, views.size()); !sound) return sound;
  }
  return {};
}

SectorView sector_view(const CullView& culled, const WorldPoint& distance_eye, const Sector& sector) {
  const WorldView& view = culled.view;
  const WorldPoint &e = distance_eye, &o = sector.origin;
  SectorView out;
  out.distance_eye = to_vec3(glm::dvec3(e.x - o.x, e.y - o.y, e.z - o.z));
  glm::dmat4 moved(1.0);
  moved[3] = glm::dvec4(o.x - view.origin.x, o.y - view.origin.y, o.z - view.origin.z, 1.0);
  const glm::dmat4 to_eye = to_double(view.view.world_to_eye) * moved;
  aim(out, culled, to_eye, view_direction(view.view), sector.map->nodes()[0].bounds);
  if (culled.occlusion) {
    out.occluders = &OcclusionAccess::tiles(*culled.occlusion);
    out.projection = out.occluders->ask->projection(view, sector.origin, out.occluders->scale);
  }
  return out;
}

// Whose eye a view's distances are measured from.
const WorldView& distance_view(std::span<const CullView> views, const CullView& view) noexcept {
  const bool own = view.distance_view == kOwnView || SIGHTLINE_MUTANT(distances_of_the_own_eye);
  return own ? view.view : views[view.distance_view].view;
}

WorldPoint eye_in_world(const WorldView& view) noexcept {
  const glm::dvec3 eye = geometry::eye_of(view.view);
  return {view.origin.x + eye.x, view.origin.y + eye.y, view.origin.z + eye.z};
}

// Views that are the same are culled once; what no column asks for makes no difference.
DifferentViews different_views(std::span<const CullView> views, const Columns& columns) noexcept {
  DifferentViews out;
  const auto same = [&](const CullView& a, const CullView& b) {
    if (a.view != b.view || a.occlusion != b.occlusion || a.casters != b.casters || a.min_area != b.min_area)
      return false;
    if (columns.has_layers ? a.layers != b.layers : (a.layers == 0) != (b.layers == 0)) return false;
    return !columns.has_distances ||
           (a.distance_scale == b.distance_scale && distance_view(views, a) == distance_view(views, b));
  };
  for (std::size_t v = 0; v < views.size(); ++v) {
    std::size_t d = 0;
    while (d < out.count && !same(views[out.first[d]], views[v])) ++d;
    if (d == out.count) out.first[out.count++] = static_cast<std::uint8_t>(v);
    out.bits[d] |= static_cast<std::uint8_t>(1u << v);
  }
  return out;
}

// The map's nodes, with the one that it gets with its first mover.
std::size_t nodes_of(const Sector& sector) {
  return sector.map->nodes().size() + (sector.map->mover_node() == ChunkMap::kNone);
}

// Sorts the sectors: adds to the state those that some view may see, and their groups. Returns how many
// regions and groups it looked at.
std::uint64_t find_entries(CullerState& state, std::span<const CullView> views,
                           const DifferentViews& different) {
  const Zone zone(state.zones, "sightline: regions and groups");
  const auto& sectors = state.world->sectors;
  const auto of_different = std::span(different.first).first(different.count);
  state.maps.clear(), state.views.clear(), state.entries.clear(), state.origins.clear();
  for (std::size_t d = 0; d < different.count; ++d) state.tests[d] = SectorTest(views[of_different[d]].view);
  if (state.world->columns.has_distances)
    for (const std::uint8_t v : of_different)
      state.distance_eyes[v] = eye_in_world(distance_view(views, views[v]));
  // Room for all sectors, so that a camera that turns allocates nothing.
  state.maps.reserve(sectors.size());
  state.origins.reserve(sectors.size());
  state.views.reserve(sectors.size() * different.count);
  for (std::size_t s = state.failed.size(); s < sectors.size(); ++s) {
    state.failed.emplace_back();
    if (sectors[s].map) state.failed[s].resize(nodes_of(sectors[s]) * kMaxViews, 0);
  }
  std::uint64_t visited = 0;
  for (std::size_t s = 0; s < sectors.size(); ++s) {
    const Sector& sector = sectors[s];
    if (!sector.map) continue;
    bool missed = true;
    for (std::size_t d = 0; d < different.count && missed; ++d)
      missed = state.tests[d].misses(sector.origin, sector.bounds);
    if (missed) {
      ++visited;  // its root: that is what the walk would have looked at
      continue;
    }
    const auto kept = static_cast<std::uint32_t>(state.maps.size());
    state.maps.push_back(sector.map.get());
    state.origins.push_back(sector.origin);
    for (const std::uint8_t v : of_different)
      state.views.push_back(sector_view(views[v], state.distance_eyes[v], sector));
    state.failed[s].resize(nodes_of(sector) * kMaxViews, 0);
    visited += RegionWalk(state, kept, different.count, state.failed[s].data()).run();
  }
  return visited;
}

// What the passes are to ask of chunks and objects besides the views' frustums.
const ColumnTests* column_tests(CullerState& state, std::span<const CullView> views,
                                const DifferentViews& different) {
  for (const CullView& view : views) {
    if (!view.casters) continue;
    if (!state.casting) state.casting = ShadowAccess::casters(*view.casters).tools->make();
    return state.casting->prepare(state, views, different);
  }
  return state.world->column_tests;
}

// Finds the groups that the views may see, and prepares the state's input. The result's nodes_visited says
// how many regions and groups it looked at.
DifferentViews begin_cull(CullerState& state, const World& world, std::span<const CullView> views,
                          CullResult& result) noexcept {
  state.world = &WorldAccess::state(world);
  state.world->note_culled();
  const DifferentViews different = different_views(views, state.world->columns);
  result.nodes_visited = find_entries(state, views, different);
  const ColumnTests* columns = column_tests(state, views, different);
  state.input = {state.maps, state.views, different.count, different.bits, {}, columns};
  return different;
}

}  // namespace

}  // namespace sightline::world
