// Culling a world into ranges of its order: the walk of any cull, and passes of its own.
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "library/world/begin_cull-inl.hpp"
#include "library/world/culler_state.hpp"
#include "library/world/object_order.hpp"
#include "library/world/range_cull.hpp"

namespace sightline {

namespace world {

namespace {

struct RangeCullerState {
  CullerState inner;
  std::vector<const std::uint32_t*> first_slots;  // of inner.maps
  std::array<Job, kMaxJobs> parts;
  std::array<RangeCounts, kMaxJobs> counts;
  geometry::LargeVector<SlotRange> ranges;
  std::vector<std::uint8_t> masks;
  RangeInput input;
  bool with_masks = false;
};

void run_range_job(void* data, std::uint32_t index) {
  auto& state = *static_cast<RangeCullerState*>(data);
  const Zone zone(state.inner.zones, "sightline: ranges");
  const Job& part = state.parts[index];
  const auto entries = std::span(state.inner.entries).subspan(part.first, part.count);
  state.counts[index] = cull_ranges(state.input, entries, &state.ranges[part.first_output],
                                    state.with_masks ? &state.masks[part.first_output] : nullptr);
}

// The order's slots of the sectors that were kept, which stand in the world's order.
void find_first_slots(RangeCullerState& state, const OrderState& order) {
  const auto& sectors = state.inner.world->sectors;
  state.first_slots.clear();
  state.first_slots.reserve(sectors.size());
  std::size_t s = 0;
  for (const ChunkMap* map : state.inner.maps) {
    while (sectors[s].map.get() != map) ++s;
    state.first_slots.push_back(order.sectors[s].first.data());
  }
}

// Moves what the jobs wrote together; where one ends and the next begins, two ranges may be one.
void join_ranges(RangeCullerState& state, std::uint32_t jobs, RangeResult& result) {
  std::size_t written = 0;
  for (std::uint32_t j = 0; j < jobs; ++j) {
    const RangeCounts& counts = state.counts[j];
    std::size_t from = state.parts[j].first_output, count = counts.written;
    if (written > 0 && count > 0) {
      SlotRange& last = state.ranges[written - 1];
      const SlotRange& next = state.ranges[from];
      if (last.first + last.count == next.first &&
          (!state.with_masks || state.masks[written - 1] == state.masks[from]))
        last.count += next.count, ++from, --count;
    }
    if (from != written) {
      std::memmove(state.ranges.data() + written, state.ranges.data() + from, count * sizeof(SlotRange));
      if (state.with_masks) std::memmove(state.masks.data() + written, state.masks.data() + from, count);
    }
    written += count;
    result.objects += counts.objects, result.tested += counts.tested;
    result.nodes_visited += counts.chunks, result.culled_occlusion += counts.occluded;
  }
  result.ranges = std::span<const SlotRange>(state.ranges).first(written);
  if (state.with_masks) result.masks = std::span<const std::uint8_t>(state.masks).first(written);
}

RangeResult write_ranges(RangeCullerState& state, const RangeOptions& options) {
  const CullerState& inner = state.inner;
  const auto objects_of = [&](std::size_t entry) {
    const GroupEntry& e = inner.entries[entry];
    return std::size_t{inner.maps[e.sector]->groups()[e.group].objects};
  };
  std::size_t total = 0;
  for (std::size_t e = 0; e < inner.entries.size(); ++e) total += objects_of(e);
  const std::uint32_t threads = options.jobs.run ? options.jobs.threads : 1,
                      jobs = split_jobs(state.parts, inner.entries.size(), total, threads, objects_of);
  const std::size_t room = total + kCullPadding * jobs;
  if (state.ranges.size() < room) state.ranges.resize(room);
  state.with_masks = options.masks;
  if (options.masks && state.masks.size() < room) state.masks.resize(room);
  if (jobs > 1) {
    options.jobs.run(options.jobs.user, jobs, run_range_job, &state);
  } else if (jobs == 1) {
    run_range_job(&state, 0);
  }
  RangeResult result;
  join_ranges(state, jobs, result);
  return result;
}

}  // namespace

}  // namespace world

struct RangeCuller::State : world::RangeCullerState {};

RangeCuller::RangeCuller() : state_(new State) {}
RangeCuller::~RangeCuller() {
  delete state_;
}
RangeCuller::RangeCuller(RangeCuller&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
RangeCuller& RangeCuller::operator=(RangeCuller&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Result<RangeResult> RangeCuller::cull(const World& world, const ObjectOrder& order,
                                      std::span<const CullView> views, const RangeOptions& options) noexcept {
  if (const Status sound = world::check_views(views, options.jobs, options.zones); !sound) return sound;
  const world::OrderState& slots = OrderAccess::state(order);
  if (!slots.is_of(WorldAccess::state(world)))
    return Status(
        StatusCode::stale_buffer,
        "ranges: the order is not that of the world as it is now, expected an update after changes");
  world::RangeCullerState& state = *state_;
  state.inner.zones = options.zones;
  const world::Zone zone(options.zones, "sightline: cull");
  CullResult found;
  (void)world::begin_cull(state.inner, world, views, found);
  world::find_first_slots(state, slots);
  state.input = {state.inner.input, state.first_slots, options.whole_chunks};
  RangeResult result = world::write_ranges(state, options);
  result.nodes_visited += found.nodes_visited;
  return result;
}

}  // namespace sightline
