// Which sectors and groups of the instances' worlds the passes are to look at.
#include <glm/glm.hpp>

#include "library/geometry/box_reader.hpp"
#include "library/geometry/linear.hpp"
#include "library/geometry/mutant.h"
#include "library/world/instance_cull.hpp"
#include "library/world/sector_walk-inl.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

// Whether all that the instance shows is seen by all of the views `by`, and nothing has to be asked of its
// objects.
bool is_seen_whole(const InstanceCullerState& state, const InstancesState& instances, const WorldState& world,
                   ObjectId id, std::uint8_t by) {
  if (world.column_tests || (state.options->levels && world.levels)) return false;
  const WorldBox box = stored_box(WorldAccess::state(instances.boxes), id);
  for (std::size_t v = 0; v < state.views.size(); ++v) {
    if ((by >> v & 1) == 0) continue;
    const CullView& view = state.views[v];
    if (view.min_area > 0 || view.occlusion) return false;
    if (SIGHTLINE_MUTANT(crossing_instances_whole)) continue;
    const Frustum& frustum = state.frustums[v];
    if (classify(frustum, relative_box(box, frustum.origin)) != Overlap::inside) return false;
  }
  return true;
}

InstancePart begin_part(const CullerState& inner, const WorldState& world) {
  InstancePart part;
  part.world = &world;
  part.first_sector = inner.maps.size(), part.first_entry = inner.entries.size();
  return part;
}

// Adds the groups of the sector whose views were added last.
void add_sector(InstanceCullerState& state, InstancePart& part, const Sector& sector) {
  CullerState& inner = state.inner;
  const std::size_t before = inner.entries.size(), views = state.views.size();
  const std::size_t nodes = sector.map->nodes().size() + 1;  // with the one that its first mover brings
  if (state.failed.size() < nodes * kMaxViews) state.failed.resize(nodes * kMaxViews, 0);
  inner.maps.push_back(sector.map.get());
  const auto number = static_cast<std::uint32_t>(inner.maps.size() - 1);
  state.nodes_visited += RegionWalk(inner, number, views, state.failed.data()).run();
  if (inner.entries.size() == before) {
    inner.maps.pop_back(), inner.views.resize(inner.views.size() - views);
    return;
  }
  for (std::size_t e = before; e < inner.entries.size(); ++e) {
    inner.entries[e].sector = static_cast<std::uint32_t>(part.sectors);
    part.most += sector.map->groups()[inner.entries[e].group].objects;
  }
  ++part.sectors;
}

std::uint32_t end_part(InstanceCullerState& state, InstancePart part) {
  part.entries = state.inner.entries.size() - part.first_entry;
  state.parts.push_back(part);
  return static_cast<std::uint32_t>(state.parts.size() - 1);
}

// A view that misses an instance.
SectorView no_view() {
  SectorView out;
  out.layers = 0;
  return out;
}

// The part that is all of the world, which several instances may share.
std::uint32_t whole_part(InstanceCullerState& state, PlacedWorldId name, const WorldState& world,
                         std::uint8_t by) {
  const std::uint8_t views = state.options->masks ? by : std::uint8_t{0};
  for (std::uint32_t p = state.whole[name]; p != ChunkMap::kNone; p = state.parts[p].next_whole)
    if (state.parts[p].views == views) return p;
  InstancePart part = begin_part(state.inner, world);
  part.views = views, part.next_whole = state.whole[name];
  for (const Sector& sector : world.sectors) {
    if (!sector.map) continue;
    for (std::size_t v = 0; v < state.views.size(); ++v)
      state.inner.views.push_back(by >> v & 1 ? SectorView{} : no_view());
    add_sector(state, part, sector);
  }
  return state.whole[name] = end_part(state, part);
}

// An instance as the views see it.
class PlacedViews {
public:
  PlacedViews(const InstanceCullerState& state, const InstancePlacement& placement) noexcept
      : state_(state), scale_(static_cast<float>(scale_of(placement))) {
    const glm::dmat4 transform = to_double(placement.transform);
    for (std::size_t v = 0; v < state.views.size(); ++v) {
      const WorldPoint &o = placement.origin, &about = state.views[v].view.origin;
      placed_[v] = transform;
      placed_[v][3] += glm::dvec4(o.x - about.x, o.y - about.y, o.z - about.z, 0);
      to_eye_[v] = to_double(state.views[v].view.view.world_to_eye) * placed_[v];
    }
  }

  [[nodiscard]] float scale() const noexcept { return scale_; }

  // View v of a sector of the instance's world.
  [[nodiscard]] SectorView of(std::size_t v, const Sector& sector, bool has_distances) const noexcept {
    const CullView& view = state_.views[v];
    const glm::dmat4 to_eye = about(to_eye_[v], sector);
    const Vec3 forward = to_vec3(-glm::dvec3(glm::inverse(to_eye)[2]));
    SectorView out;
    aim(out, view, to_eye, forward, sector.map->nodes()[0].bounds);
    // From afar nothing grows smaller: sizes are the placed objects'.
    if (out.orthographic) out.area_scale *= scale_ * scale_;
    if (has_distances) {
      const std::size_t by = view.distance_view == kOwnView ? v : view.distance_view;
      out.distance_eye = to_vec3(glm::dvec3(glm::inverse(about(to_eye_[by], sector))[3]));
    }
    if (view.occlusion) {
      out.occluders = &OcclusionAccess::tiles(*view.occlusion);
      out.projection =
          occlusion::placed_projection(view.view.view, about(placed_[v], sector), out.occluders->scale);
    }
    return out;
  }

private:
  static glm::dmat4 about(const glm::dmat4& matrix, const Sector& sector) noexcept {
    glm::dmat4 out = matrix;
    out[3] = matrix * glm::dvec4(sector.origin.x, sector.origin.y, sector.origin.z, 1);
    return out;
  }

  const InstanceCullerState& state_;
  float scale_;
  std::array<glm::dmat4, kMaxViews> placed_, to_eye_;  // to metres about the view's origin, to eye space
};

}  // namespace

void find_part(InstanceCullerState& state, const InstancesState& instances, ObjectId id, std::uint8_t by) {
  const InstancePlacement& placement = instances.placements[id];
  const WorldState& world = WorldAccess::state(*instances.worlds[placement.world].world);
  if (world.size == 0) return;
  if (is_seen_whole(state, instances, world, id, by)) {
    state.seen.push_back({id, whole_part(state, placement.world, world, by)});
    return;
  }
  const PlacedViews placed(state, placement);
  InstancePart part = begin_part(state.inner, world);
  part.scale = placed.scale();
  const bool chooses = state.options->levels && world.levels;
  for (const Sector& sector : world.sectors) {
    if (!sector.map) continue;
    for (std::size_t v = 0; v < state.views.size(); ++v) {
      const bool sees = by >> v & 1, needed = sees || (chooses && v == state.options->level_options.view);
      SectorView& view = state.inner.views.emplace_back(no_view());
      if (needed) view = placed.of(v, sector, world.columns.has_distances);
      if (!sees) view.layers = 0;
    }
    add_sector(state, part, sector);
  }
  if (part.sectors > 0) state.seen.push_back({id, end_part(state, part)});
}

}  // namespace sightline::world
