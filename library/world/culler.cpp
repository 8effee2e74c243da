// Culling a world: the regions and groups are sorted here, one by one; what is left goes to the SIMD passes,
// in as many jobs as the caller has threads.
#include <algorithm>
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
#include "library/world/begin_cull-inl.hpp"
#include "library/world/culler_state.hpp"
#include "library/world/mask_counts.hpp"

namespace sightline {

namespace world {

using namespace geometry;

namespace {

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
    return {StatusCode::buffer_too_small, "cull: expected room for as many ids as the cull capacity"};
  if (!output.masks.empty() && output.masks.size() < needed)
    return {StatusCode::buffer_too_small,
            "cull: expected room for as many masks as the cull capacity, or none"};
  for (const std::span<std::uint8_t> bytes : {output.levels, output.fades})
    if (!bytes.empty() && bytes.size() < needed)
      return {StatusCode::buffer_too_small,
              "cull: expected room for as many levels and fades as the cull capacity, or none"};
  if (output.levels.empty() && !output.fades.empty())
    return {StatusCode::bad_argument, "cull: fades without levels, expected both or no fades"};
  const Levels* const levels = output.levels.empty() ? nullptr : WorldAccess::state(world).levels.get();
  if (levels) {
    if (const Status sound = levels->check(options.levels, views.size()); !sound) return sound;
  }
  if (options.occlusion == Occlusion::none) return {};
  if (options.occlusion != Occlusion::automatic)
    return {StatusCode::bad_argument, "cull: the options' occlusion is neither none nor automatic"};
  return check_automatic(views, options.buffer, options.costs);
}

void write_values(const Columns& columns, std::span<ObjectId> ids) noexcept {
  if (!columns.has_values) return;
  for (ObjectId& id : ids) id = columns.values[id];
}

// What the passes cost, and what else the world's occluders hide.
void hide(CullerState& state, std::span<const CullView> views, const DifferentViews& different,
          const CullOptions& options, CullResult& result) {
  if (state.hiding) state.hiding->forget_drawn();
  CullCosts costs = options.costs;
  if (costs.object == 0) costs.object = static_cast<float>(state.object_cost.value(double{kObjectCost}));
  result.frustum_cost = result.cost =
      static_cast<double>(result.nodes_visited) * double{costs.node} +
      static_cast<double>(result.tested) * double{costs.test} +
      static_cast<double>(count_drawn(state, result.count)) * double{costs.object};
  const WorldOccluders* occluders = state.world->occluders.get();
  if (occluders && occluders->any() && result.count > 0 && state.account.begins_try(result.frustum_cost)) {
    const Zone zone(state.zones, "sightline: automatic occlusion");
    if (!state.hiding) state.hiding = occluders->make_hiding();
    state.hiding->hide(state, views, different, options, costs, result);
  }
  state.account.close_frame(result.cost, result.frustum_cost);
}

}  // namespace

Zone::Zone(const CullZones& zones, const char* name) noexcept : zones_(zones) {
  if (zones_.begin) zones_.begin(zones_.user, name);
}
Zone::~Zone() {
  if (zones_.end) zones_.end(zones_.user);
}

std::uint64_t count_drawn(CullerState& state, std::size_t count) noexcept {
  return state.masks ? count_bits({state.masks, count}) : count;
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
  if (!bytes.empty()) std::memset(bytes.data(), 0, count);
}

}  // namespace

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
  if (levels) levels->begin(state, views, different, options.levels, output);
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
  // No frame takes less than a microsecond: what says so is in other units. And eleven days: what costs are
  // made of stays a float.
  constexpr double kShortest = 1e3, kLongest = 1e15;
  if (!(nanoseconds >= kShortest) || !(nanoseconds <= kLongest))
    return {StatusCode::bad_argument,
            "cull: a frame's time is out of range, expected 1000 to 1e15 nanoseconds"};
  state_->object_cost.took(nanoseconds);
  return {};
}

}  // namespace sightline
