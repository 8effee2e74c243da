// Culling a world: the regions and groups are sorted here, one by one; what is left goes to the SIMD passes,
// in as many jobs as the caller has threads.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>
#include <vector>

#include <sightline/frustum.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/projection.hpp>

#include "library/geometry/linear.hpp"
#include "library/geometry/mutant.h"
#include "library/world/culler_state.hpp"
#include "library/world/sector_walk-inl.hpp"

namespace sightline {

namespace world {

using namespace geometry;

namespace {

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

void run_job(void* data, std::uint32_t index) {
  auto& state = *static_cast<CullerState*>(data);
  const Zone zone(state.zones, "sightline: chunks and objects");
  Job& job = state.jobs[index];
  const auto entries = std::span(state.entries).subspan(job.first, job.count);
  PassInput input = state.input;
  if (!input.hidden.empty())
    input.hidden = input.hidden.subspan(job.first * input.view_count, job.count * input.view_count);
  ObjectId* ids = state.out + job.first_output;
  std::uint8_t* masks = state.masks ? state.masks + job.first_output : nullptr;
  job.counts = cull_groups(input, entries, ids, masks);
}

std::uint32_t split_work(CullerState& state, std::uint32_t threads) {
  const auto objects_of = [&](std::size_t entry) {
    const GroupEntry& e = state.entries[entry];
    return state.maps[e.sector]->groups()[e.group].objects;
  };
  std::size_t total = 0;
  for (std::size_t e = 0; e < state.entries.size(); ++e) total += objects_of(e);
  return split_jobs(state.jobs, state.entries.size(), total, threads, objects_of);
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

// Moves what the jobs wrote together, behind the result's, and adds their counts to it.
void join_outputs(const CullerState& state, std::uint32_t jobs, CullResult& result) {
  for (const Job& job : std::span(state.jobs).first(jobs)) {
    if (job.first_output != result.count) {
      std::memmove(state.out + result.count, state.out + job.first_output,
                   job.counts.written * sizeof(ObjectId));
      if (state.masks)
        std::memmove(state.masks + result.count, state.masks + job.first_output, job.counts.written);
    }
    result.count += job.counts.written;
    result.tested += job.counts.tested;
    result.nodes_visited += job.counts.chunks;
    result.culled_occlusion += job.counts.occluded;
  }
}

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

Status check_automatic(std::span<const CullView> views, const OcclusionOptions& buffer,
                       const CullCosts& costs) noexcept {
  if (buffer.scale != 1 && buffer.scale != 2 && buffer.scale != 4)
    return {StatusCode::bad_argument, "cull: the buffer's scale is none, expected 1, 2 or 4"};
  if (buffer.coverage != Coverage::centres && buffer.coverage != Coverage::area)
    return {StatusCode::bad_argument, "cull: the buffer's coverage is none, expected centres or area"};
  for (const float cost : {costs.object, costs.node, costs.test, costs.candidate, costs.tile, costs.shape,
                           costs.triangle, costs.query, costs.occludee}) {
    if (!(cost >= 0) || !std::isfinite(cost))
      return {StatusCode::bad_argument, "cull: a cost is negative or not finite"};
  }
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (views[v].occlusion)
      return {StatusCode::bad_argument, "cull: a view brings a buffer, though occlusion is automatic", v};
  }
  return {};
}

Status check_call(const World& world, std::span<const CullView> views, const CullOptions& options,
                  const CullOutput& output) noexcept {
  if (const Status sound = check_views(views, options.jobs, options.zones); !sound) return sound;
  const std::size_t needed = cull_capacity(world, options);
  if (output.ids.size() < needed)
    return {StatusCode::buffer_too_small, "cull: expected room for cull_capacity() ids"};
  if (!output.masks.empty() && output.masks.size() < needed)
    return {StatusCode::buffer_too_small, "cull: expected room for cull_capacity() masks, or none"};
  if (options.occlusion == Occlusion::none) return {};
  if (options.occlusion != Occlusion::automatic)
    return {StatusCode::bad_argument, "cull: the options' occlusion is neither none nor automatic"};
  return check_automatic(views, options.buffer, options.costs);
}

void write_values(const Columns& columns, std::span<ObjectId> ids) noexcept {
  if (!columns.has_values) return;
  for (ObjectId& id : ids) id = columns.values[id];
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

// What the passes cost, and what else the world's occluders hide.
void hide(CullerState& state, std::span<const CullView> views, const DifferentViews& different,
          const CullOptions& options, CullResult& result) {
  CullCosts costs = options.costs;
  if (costs.object == 0) costs.object = static_cast<float>(state.object_cost.value(double{kObjectCost}));
  result.frustum_cost = result.cost =
      static_cast<double>(result.nodes_visited) * double{costs.node} +
      static_cast<double>(result.tested) * double{costs.test} +
      static_cast<double>(count_drawn(state, result.count)) * double{costs.object};
  const WorldOccluders* occluders = state.world->occluders.get();
  if (occluders && occluders->any() && result.count > 0 && state.account.begins_try()) {
    const Zone zone(state.zones, "sightline: automatic occlusion");
    if (!state.hiding) state.hiding = occluders->make_hiding();
    state.hiding->hide(state, views, different, options, costs, result);
  }
  state.account.close_frame(result.cost, result.frustum_cost);
}

}  // namespace

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

DifferentViews begin_cull(CullerState& state, const World& world, std::span<const CullView> views,
                          CullResult& result) noexcept {
  state.world = &WorldAccess::state(world);
  auto& culled = state.world->culled;
  if (!culled.load(std::memory_order_relaxed)) culled.store(true, std::memory_order_relaxed);
  const DifferentViews different = different_views(views, state.world->columns);
  result.nodes_visited = find_entries(state, views, different);
  const ColumnTests* columns = column_tests(state, views, different);
  state.input = {state.maps, state.views, different.count, different.bits, {}, columns};
  return different;
}

Zone::Zone(const CullZones& zones, const char* name) noexcept : zones_(zones) {
  if (zones_.begin) zones_.begin(zones_.user, name);
}
Zone::~Zone() {
  if (zones_.end) zones_.end(zones_.user);
}

std::uint64_t count_drawn(CullerState& state, std::size_t count) noexcept {
  const std::uint8_t* masks = state.masks;
  if (!masks) return count;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += static_cast<std::uint64_t>(std::popcount(masks[i]));
  return sum;
}

void run_passes(CullerState& state, const JobSystem& jobs, CullResult& result) {
  const std::uint32_t count = split_work(state, jobs.run ? jobs.threads : 1);
  if (count > 1) {
    jobs.run(jobs.user, count, run_job, &state);
  } else if (count == 1) {
    run_job(&state, 0);
  }
  join_outputs(state, count, result);
}

}  // namespace world

namespace {

// Of a world without tables.
void write_no_levels(std::span<std::uint8_t> bytes, std::size_t count) {
  if (!bytes.empty()) std::memset(bytes.data(), 0, std::min(count, bytes.size()));
}

}  // namespace

struct Culler::State : world::CullerState {};

std::size_t cull_capacity(const World& world, const CullOptions& options) noexcept {
  return world.size() + kCullPadding * std::clamp(options.jobs.threads, 1u, kMaxJobs);
}

Culler::Culler() : state_(new State) {}
Culler::~Culler() {
  delete state_;
}
Culler::Culler(Culler&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
Culler& Culler::operator=(Culler&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Result<CullResult> Culler::cull(const World& world, std::span<const CullView> views,
                                const CullOptions& options, const CullOutput& output) noexcept {
  if (const Status sound = world::check_call(world, views, options, output); !sound) return sound;
  world::CullerState& state = *state_;
  state.zones = options.zones;
  const world::Zone zone(state.zones, "sightline: cull");
  CullResult result;
  const world::DifferentViews different = world::begin_cull(state, world, views, result);
  world::Levels* const levels = output.levels.empty() ? nullptr : state.world->levels.get();
  if (levels) {
    if (const Status sound = levels->begin(state, views, different, options.levels, output); !sound)
      return sound;
  }
  state.out = output.ids.data();
  state.masks = output.masks.empty() ? nullptr : output.masks.data();
  world::run_passes(state, options.jobs, result);
  if (options.occlusion == Occlusion::automatic) world::hide(state, views, different, options, result);
  state.object_cost.drew(result.count);
  if (levels) {
    levels->write(state, result.count, output);
  } else {
    write_no_levels(output.levels, result.count), write_no_levels(output.fades, result.count);
  }
  if (options.values_for_ids) world::write_values(state.world->columns, output.ids.first(result.count));
  return result;
}

Status Culler::report_frame_time(double nanoseconds) noexcept {
  if (!(nanoseconds >= 0) || !std::isfinite(nanoseconds))
    return {StatusCode::bad_argument, "cull: a frame's time is negative or not finite"};
  state_->object_cost.took(nanoseconds);
  return {};
}

}  // namespace sightline
