// Culling instances of worlds: their boxes first, then the worlds of those that are left, each in its own
// space, by the passes that cull worlds.
#include "library/world/instance_cull.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "library/geometry/mutant.h"
#include "library/world/lane_levels.hpp"

namespace sightline {

namespace world {

namespace {

// The levels of a part's objects, in the order in which the passes write them.
class PartLevels final : public LevelNotes {
public:
  PartLevels(const WorldLevels& levels, const LevelScale& scale, std::size_t view, float placed,
             std::uint8_t* out, std::uint8_t* fades) noexcept
      : levels_(levels), scale_(scale), view_(view), out_(out), fades_(fades) {
    if (scale.orthographic) scale_.squared *= placed * placed;
  }

  PassCounts cull(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* ids,
                  std::uint8_t* masks) noexcept override {
    return cull_noted(*this, input, entries, ids, masks);
  }

  LaneBlocks blocks_of(std::uint32_t /*sector*/, std::uint32_t /*pool*/) noexcept override { return {}; }

  void expect(const ChunkMap::ChunkView& chunk, const LaneBlocks& /*blocks*/) noexcept override {
    for (std::size_t i = 0; i < chunk.count; i += kLaneBlock) expect_sizes(chunk, i);
  }

  void note(const NotedChunk& noted) noexcept override {
    const ChunkMap::ChunkView& chunk = noted.chunk;
    alignas(64) std::array<float, ChunkMap::kCapacity> sizes;
    find_sizes(chunk, noted.views[view_].eye, scale_, sizes.data());
    for (std::uint32_t slot = 0; slot < chunk.count; ++slot)
      if (noted.seen.at(slot)) write(levels_.table(chunk.objects[slot]), sizes[slot]);
  }

private:
  void write(const LevelTable& table, float size) noexcept {
    std::uint32_t level = 0;
    for (const float limit : table.sizes) level += size < limit;
    *out_++ = static_cast<std::uint8_t>(level);
    *fades_++ = fade_at(size, table.sizes[level], scale_.fade);
  }

  const WorldLevels& levels_;
  LevelScale scale_;
  std::size_t view_;
  std::uint8_t *out_, *fades_;
};

// Writes a part behind the job's first `written`.
void cull_part(InstanceCullerState& state, InstancePart& part, Job& job) {
  const CullerState& inner = state.inner;
  const std::size_t views = state.views.size();
  part.first = job.first_output + job.counts.written;
  PassInput input;
  input.maps = std::span(inner.maps).subspan(part.first_sector, part.sectors);
  input.views = std::span(inner.views).subspan(part.first_sector * views, part.sectors * views);
  input.view_count = views;
  for (std::size_t v = 0; v < views; ++v) input.bits[v] = static_cast<std::uint8_t>(1u << v);
  input.columns = part.world->column_tests;
  const bool levels = state.options->levels;
  const auto* chosen = levels ? static_cast<const WorldLevels*>(part.world->levels.get()) : nullptr;
  static const WorldLevels none;
  PartLevels notes(chosen ? *chosen : none, state.levels_by, state.options->level_options.view, part.scale,
                   levels ? &state.levels[part.first] : nullptr, levels ? &state.fades[part.first] : nullptr);
  if (chosen) input.levels = &notes;
  const auto entries = std::span(inner.entries).subspan(part.first_entry, part.entries);
  ObjectId* ids = &state.ids[part.first];
  const PassCounts counts =
      cull_groups(input, entries, ids, state.options->masks ? &state.masks[part.first] : nullptr);
  part.count = counts.written;
  if (levels && !chosen) {
    std::memset(&state.levels[part.first], 0, part.count);
    std::memset(&state.fades[part.first], 0, part.count);
  }
  const Columns& columns = part.world->columns;
  if (state.options->values_for_ids && columns.has_values)
    for (ObjectId& id : std::span(ids, part.count)) id = columns.values[id];
  job.counts.written += counts.written, job.counts.tested += counts.tested;
  job.counts.chunks += counts.chunks, job.counts.occluded += counts.occluded;
}

void run_instance_job(void* data, std::uint32_t index) {
  auto& state = *static_cast<InstanceCullerState*>(data);
  const Zone zone(state.options->zones, "sightline: objects of instances");
  Job& job = state.jobs[index];
  for (InstancePart& part : std::span(state.parts).subspan(job.first, job.count)) cull_part(state, part, job);
}

// Moves what a job wrote to `to`, and says so to its parts.
void move_output(InstanceCullerState& state, const Job& job, std::size_t to) {
  const std::size_t from = job.first_output, count = job.counts.written;
  if (from == to) return;
  // What is not wanted may be there from an earlier cull, with less room.
  const auto move = [&](auto& rows, bool wanted) {
    if (wanted) std::memmove(rows.data() + to, rows.data() + from, count * sizeof rows[0]);
  };
  move(state.ids, true), move(state.masks, state.options->masks);
  move(state.levels, state.options->levels), move(state.fades, state.options->levels);
  for (InstancePart& part : std::span(state.parts).subspan(job.first, job.count)) part.first -= from - to;
}

// Only grows, and not where nothing is wanted.
template <class Rows>
void make_room(Rows& rows, std::size_t room, bool wanted = true) {
  if (wanted && rows.size() < room) rows.resize(room);
}

Status bad_option(const char* message, std::size_t index = Status::kNoIndex) {
  return {StatusCode::bad_argument, message, index};
}

Status check_options(std::span<const CullView> views, const InstanceCullOptions& options) {
  for (std::size_t v = 0; v < views.size(); ++v)
    if (views[v].casters) return bad_option("instances: a view has casters, which instances do not have", v);
  if (options.most_objects > std::size_t{1} << 31)
    return bad_option("instances: most_objects is out of range, expected 2^31 or less");
  if (!options.levels) return {};
  const LevelOptions& levels = options.level_options;
  if (levels.hysteresis != 0)
    return bad_option("instances: the levels' hysteresis is not 0, and nothing is remembered of instances");
  return check_level_sizes(levels, views.size());
}

bool holds_all(const WorldBounds& outer, const WorldBounds& inner) {
  if (inner.empty || outer.empty) return inner.empty;
  const WorldBox &o = outer.box, &i = inner.box;
  return o.min.x <= i.min.x && o.min.y <= i.min.y && o.min.z <= i.min.z && o.max.x >= i.max.x &&
         o.max.y >= i.max.y && o.max.z >= i.max.z;
}

// Whether instances' boxes still hold what they show. As any cull, this lets the worlds' next change begin a
// frame.
Status check_worlds(const InstancesState& instances) {
  for (std::size_t w = 0; w < instances.worlds.size(); ++w) {
    const PlacedWorld& placed = instances.worlds[w];
    if (placed.instances == 0) continue;
    const WorldState& world = WorldAccess::state(*placed.world);
    if (!holds_all(placed.bounds, bounds_of(world)))
      return bad_option(
          "instances: a world reaches elsewhere since its instances were placed, expected an update", w);
  }
  return {};
}

// Culls the instances' boxes: state.instances, and with several views who sees each. `min_area` speaks of
// objects, not of all that an instance shows.
Result<CullResult> cull_boxes_of(InstanceCullerState& state, const InstancesState& instances) {
  std::array<CullView, kMaxViews> views;
  const std::size_t count = std::min(state.views.size(), kMaxViews);
  std::copy_n(state.views.begin(), count, views.begin());
  for (CullView& view : views)
    if (view.min_area > 0 && std::isfinite(view.min_area)) view.min_area = 0;
  CullOptions options;
  options.jobs = state.options->jobs, options.zones = state.options->zones;
  const std::size_t room = cull_capacity(instances.boxes, options);
  make_room(state.instances, room);
  make_room(state.instance_views, room);
  CullOutput output{state.instances};
  if (state.views.size() > 1) output.masks = state.instance_views;
  // More views than there may be are refused before they are looked at.
  const std::span<const CullView> given =
      state.views.size() > kMaxViews ? state.views : std::span(views).first(count);
  return state.outer.cull(instances.boxes, given, options, output);
}

// All parts of what the instances in view show.
void find_parts(InstanceCullerState& state, const InstancesState& instances, std::size_t count) {
  const Zone zone(state.options->zones, "sightline: instances");
  CullerState& inner = state.inner;
  inner.maps.clear(), inner.views.clear(), inner.entries.clear();
  state.parts.clear(), state.seen.clear();
  state.whole.assign(instances.worlds.size(), ChunkMap::kNone);
  state.nodes_visited = 0;
  for (std::size_t v = 0; v < state.views.size(); ++v) state.frustums[v] = make_frustum(state.views[v].view);
  for (std::size_t i = 0; i < count; ++i)
    find_part(state, instances, state.instances[i], state.views.size() > 1 ? state.instance_views[i] : 1);
}

void list_ranges(InstanceCullerState& state, InstanceCullResult& result) {
  state.ranges.clear();
  for (const SeenInstance& seen : state.seen) {
    const InstancePart& part = state.parts[seen.part];
    if (part.count == 0) continue;
    state.ranges.push_back(
        {seen.instance, static_cast<std::uint32_t>(part.first), static_cast<std::uint32_t>(part.count)});
    result.objects += part.count;
  }
  result.ranges = state.ranges;
}

// Writes what the parts' passes see of `total` objects, in jobs, into the state's ids, masks, levels and
// fades, and where it stands into the parts.
void write_parts(InstanceCullerState& state, std::size_t total, InstanceCullResult& result) {
  const InstanceCullOptions& options = *state.options;
  const auto objects_of = [&](std::size_t part) { return state.parts[part].most; };
  const std::uint32_t threads = options.jobs.run ? options.jobs.threads : 1;
  const std::uint32_t jobs = split_jobs(state.jobs, state.parts.size(), total, threads, objects_of);
  const std::size_t room = total + kCullPadding * (jobs + 1);
  make_room(state.ids, room);
  make_room(state.masks, room, options.masks);
  make_room(state.levels, room, options.levels), make_room(state.fades, room, options.levels);
  if (jobs > 1) {
    options.jobs.run(options.jobs.user, jobs, run_instance_job, &state);
  } else if (jobs == 1) {
    run_instance_job(&state, 0);
  }
  std::size_t written = 0;
  for (const Job& job : std::span(state.jobs).first(jobs)) {
    move_output(state, job, written);
    written += job.counts.written;
    result.tested += job.counts.tested, result.nodes_visited += job.counts.chunks;
    result.culled_occlusion += job.counts.occluded;
  }
  result.ids = std::span(state.ids).first(written);
  if (options.masks) result.masks = std::span(state.masks).first(written);
  if (options.levels)
    result.levels = std::span(state.levels).first(written),
    result.fades = std::span(state.fades).first(written);
}

}  // namespace

}  // namespace world

struct InstanceCuller::State : world::InstanceCullerState {};

InstanceCuller::InstanceCuller() : state_(new State) {}
InstanceCuller::~InstanceCuller() {
  delete state_;
}
InstanceCuller::InstanceCuller(InstanceCuller&& other) noexcept
    : state_(std::exchange(other.state_, nullptr)) {}
InstanceCuller& InstanceCuller::operator=(InstanceCuller&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Result<InstanceCullResult> InstanceCuller::cull(const Instances& instances, std::span<const CullView> views,
                                                const InstanceCullOptions& options) noexcept {
  if (const Status sound = world::check_options(views, options); !sound) return sound;
  const world::InstancesState& placed = InstancesAccess::state(instances);
  if (const Status sound = world::check_worlds(placed); !sound) return sound;
  world::InstanceCullerState& state = *state_;
  state.views = views, state.options = &options;
  const Result<CullResult> outer = world::cull_boxes_of(state, placed);
  if (!outer) return outer.error();
  if (options.levels)
    state.levels_by = world::level_scale(views[options.level_options.view].view, options.level_options);
  world::find_parts(state, placed, outer->count);
  std::size_t most = 0;
  for (const world::InstancePart& part : state.parts) most += part.most;
  if (most > options.most_objects)
    return Status(StatusCode::too_many, "instances: the views may see more objects than most_objects");
  for (const world::PlacedWorld& shown : placed.worlds)
    if (shown.instances > 0) WorldAccess::state(*shown.world).note_culled();
  InstanceCullResult result;
  world::write_parts(state, most, result);
  result.tested += outer->tested, result.nodes_visited += outer->nodes_visited + state.nodes_visited;
  result.culled_occlusion += outer->culled_occlusion;
  world::list_ranges(state, result);
  return result;
}

}  // namespace sightline
