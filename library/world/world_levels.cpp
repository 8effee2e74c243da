#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include <sightline/projection.hpp>

#include "library/geometry/ask_ahead.hpp"
#include "library/geometry/linear.hpp"
#include "library/geometry/mutant.h"
#include "library/world/culler_state.hpp"
#include "library/world/lane_levels.hpp"

namespace sightline {

namespace world {

namespace {

constexpr std::size_t kMostTables = 65535, kFewChanges = 256;

// Unlike all that came before.
std::uint64_t next_edition() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

// Blocks of a pool's lanes, and when they were last in view.
struct PoolLevels {
  geometry::LargeVector<LaneState> states;
  geometry::LargeVector<LaneLimits> limits;
  ChunkMap::LaneVersion version;
  bool unchanged = false;  // it is what it was at the cull before
};

// What is known of a sector's objects.
struct SectorLevels {
  std::array<PoolLevels, ChunkMap::kPools> pools;
  std::uint16_t cull = 0;  // its last
};

// A lane of a map's pools.
struct Lane {
  std::size_t pool = 0, lane = 0;
};
Lane lane_of(const ChunkMap& map, const ObjectId* object) noexcept {
  std::size_t pool = 0;
  const auto holds = [&](std::span<const ObjectId> ids) {
    return !std::less()(object, ids.data()) && std::less()(object, ids.data() + ids.size());
  };
  while (!holds(map.pool_ids(pool))) ++pool;
  return {pool, static_cast<std::size_t>(object - map.pool_ids(pool).data())};
}

// What a key knows, as its culls follow one another.
class KeyLevels {
public:
  // Prepares a cull of the sectors that the state's views may see.
  LaneChoice begin(const WorldLevels& levels, const CullerState& state, const WorldView& view,
                   const LevelOptions& options, bool faded) {
    if (cull_ == std::numeric_limits<std::uint16_t>::max()) renumber_culls();
    const bool any_moved = !options.cut && find_moved(*state.world);
    // Where nothing is remembered no cull is the last.
    const std::uint16_t last = options.cut ? std::uint16_t{0} : cull_;
    ++cull_;
    make_room(state);
    const Chosen chosen = chosen_by(levels, view, options, faded);
    if (last_.edition != chosen.edition) ++editions_, followed_ = levels.changed().size();
    epochs_ += last_ != chosen;
    last_ = chosen;
    follow_changes(levels, *state.world);
    travel(view);
    LaneChoice out;
    out.levels = &levels;
    if (any_moved) out.moved = moved_;
    out.tables_changed = !levels.changed().empty();
    out.edition = editions_, out.epoch = epochs_;
    out.cull = cull_, out.last = last;
    out.scale = chosen.scale, out.finer = chosen.finer, out.coarser = chosen.coarser;
    out.travelled = travelled_;
    return out;
  }

  // Of the state's i-th map.
  [[nodiscard]] SectorLevels& seen(std::size_t i) noexcept { return sectors_[places_[i]]; }
  [[nodiscard]] const SectorLevels& sector(std::size_t place) const noexcept { return sectors_[place]; }

private:
  // By what levels are chosen, but for the eye.
  struct Chosen {
    std::uint64_t edition = 0;
    LevelScale scale;
    float finer = 0, coarser = 0;
    bool operator==(const Chosen&) const = default;
  };
  static Chosen chosen_by(const WorldLevels& levels, const WorldView& view, const LevelOptions& options,
                          bool faded) {
    Chosen out{levels.edition(), level_scale(view, options), 1 + options.hysteresis, 1 - options.hysteresis};
    if (!faded) out.scale.fade = 0;
    if (SIGHTLINE_MUTANT(levels_without_memory)) out.finer = out.coarser = 1;
    return out;
  }

  // Notes new tables of objects that were in view.
  void follow_changes(const WorldLevels& levels, const WorldState& world) {
    for (; followed_ < levels.changed().size(); ++followed_) {
      const ObjectId id = levels.changed()[followed_];
      const ChunkMap::Location& object = world.objects[id];
      if (object.sector >= sectors_.size() || !world.sectors[object.sector].map) continue;
      const ChunkMap& map = *world.sectors[object.sector].map;
      if (object.chunk >= map.chunk_limit()) continue;  // not in memory
      const Lane at = lane_of(map, map.chunk(object.chunk).objects + object.slot());
      PoolLevels& pool = sectors_[object.sector].pools[at.pool];
      const std::size_t block = at.lane / kLaneBlock;
      if (block < pool.states.size())
        renew_table({pool.states[block], pool.limits[block]}, at.lane % kLaneBlock, id, levels.table(id));
    }
  }

  void travel(const WorldView& view) {
    const glm::dvec3 origin(view.origin.x, view.origin.y, view.origin.z);
    const glm::dvec3 eye = origin + glm::dvec3(glm::inverse(geometry::to_double(view.view.world_to_eye))[3]);
    if (!SIGHTLINE_MUTANT(levels_of_a_standing_eye)) travelled_ += glm::distance(eye, eye_);
    eye_ = eye;
    // In the length of a path beyond this small steps would be lost.
    constexpr double kLongestPath = 1e7;
    if (travelled_ > kLongestPath) travelled_ = 0, ++epochs_;
  }

  void make_room(const CullerState& state) {
    const auto& sectors = state.world->sectors;
    if (sectors_.size() < sectors.size()) sectors_.resize(sectors.size());
    places_.clear();
    places_.reserve(sectors.size());
    for (std::size_t s = 0; s < sectors.size() && places_.size() < state.maps.size(); ++s) {
      const ChunkMap* const map = sectors[s].map.get();
      if (map != state.maps[places_.size()]) continue;
      places_.push_back(s);
      sectors_[s].cull = cull_;
      for (std::size_t p = 0; p < ChunkMap::kPools; ++p) {
        PoolLevels& pool = sectors_[s].pools[p];
        const std::size_t blocks = map->pool_ids(p).size() / kLaneBlock;
        if (pool.states.size() < blocks) pool.states.resize(blocks), pool.limits.resize(blocks);
        pool.unchanged = pool.version == map->lane_version(p);
        pool.version = map->lane_version(p);
      }
    }
  }

  // Notes the levels of objects that the last cull had in view and that are not where they were. Returns
  // whether there are any.
  bool find_moved(const WorldState& world) {
    bool any = false;
    for (std::size_t s = 0; s < sectors_.size(); ++s) {
      if (cull_ == 0 || sectors_[s].cull != cull_) continue;
      const ChunkMap* const map = s < world.sectors.size() ? world.sectors[s].map.get() : nullptr;
      for (std::size_t p = 0; p < ChunkMap::kPools; ++p) {
        const PoolLevels& pool = sectors_[s].pools[p];
        if (map && pool.version == map->lane_version(p)) continue;
        const std::span<const ObjectId> ids = map ? map->pool_ids(p) : std::span<const ObjectId>();
        count_objects(map, p, std::max(pool.states.size(), ids.size() / kLaneBlock));
        for (std::size_t b = 0; b < pool.states.size(); ++b) {
          if (pool.states[b].cull != cull_) continue;
          const std::span<const ObjectId> there =
              counts_[b] > 0 ? ids.subspan(b * kLaneBlock, counts_[b]) : std::span<const ObjectId>();
          any |= note_moved(pool.states[b], pool.limits[b], there, world.objects.size());
        }
      }
    }
    return any;
  }

  // Of each block of a pool, how many of its lanes belong to a chunk's objects: the others' ids mean nothing.
  void count_objects(const ChunkMap* map, std::size_t pool, std::size_t blocks) {
    counts_.assign(blocks, 0);
    if (!map) return;
    for (const ChunkMap::Group& group : map->groups()) {
      for (std::uint32_t i = 0; group.pool == pool && i < group.count; ++i) {
        std::uint8_t* at = &counts_[group.first_lane[i] / kLaneBlock];
        for (std::size_t left = map->chunk(group, i).count; left > 0; left -= *at++)
          *at = static_cast<std::uint8_t>(std::min(left, kLaneBlock));
      }
    }
  }

  bool note_moved(const LaneState& state, const LaneLimits& limits, std::span<const ObjectId> there,
                  std::size_t ids) {
    std::uint32_t moved = SIGHTLINE_MUTANT(levels_of_movers_forgotten) ? 0 : state.seen;
    for (std::size_t lane = 0; lane < there.size(); ++lane)
      moved &= ~(std::uint32_t{there[lane] == limits.ids[lane]} << lane);
    for (std::uint32_t rest = moved; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
      const ObjectId id = limits.ids[lane];
      if (id >= moved_.size()) moved_.resize(std::max(ids, id + std::size_t{1}));
      moved_[id] = {cull_, state.level[lane]};
    }
    return moved != 0;
  }

  // What was seen at the last cull was seen at the first, all else at none.
  void renumber_culls() {
    const auto renumber = [last = cull_](std::uint16_t& cull) { cull = cull == last; };
    for (MovedLevel& level : moved_) renumber(level.cull);
    for (SectorLevels& sector : sectors_) {
      renumber(sector.cull);
      for (PoolLevels& pool : sector.pools)
        for (LaneState& state : pool.states) renumber(state.cull);
    }
    cull_ = 1;
  }

  std::vector<SectorLevels> sectors_;  // by the world's sector
  std::vector<std::size_t> places_;    // of those that the views may see
  std::vector<std::uint8_t> counts_;   // of count_objects()
  geometry::LargeVector<MovedLevel> moved_;
  Chosen last_;
  glm::dvec3 eye_{};
  double travelled_ = 0;
  std::size_t followed_ = 0;  // of the tables' changes
  std::uint32_t editions_ = 1, epochs_ = 1;
  std::uint16_t cull_ = 0;
};

// Told of chunks, it chooses their objects' levels.
class RememberedLevels final : public LevelMemory, public LevelNotes {
public:
  void begin(const WorldLevels& levels, const CullerState& state, const CullOutput& output,
             const WorldView& view, std::size_t decider, const LevelOptions& options) {
    key_ = &keys_[options.key];
    choice_ = key_->begin(levels, state, view, options, !output.fades.empty());
    out_ = output.ids.data();
    decider_ = SIGHTLINE_MUTANT(levels_by_each_view) ? 0 : decider;
    const std::size_t room = state.world->size + kMaxJobs * kCullPadding;
    if (chosen_.size() < room) chosen_.resize(room);
  }

  PassCounts cull(const PassInput& input, std::span<const GroupEntry> entries, ObjectId* ids,
                  std::uint8_t* masks) noexcept override {
    return cull_noted(*this, input, entries, ids, masks);
  }

  LaneBlocks blocks_of(std::uint32_t sector, std::uint32_t pool) noexcept override {
    PoolLevels& of = key_->seen(sector).pools[pool];
    return {of.states.data(), of.limits.data(), of.unchanged};
  }

  void expect(const ChunkMap::ChunkView& chunk, const LaneBlocks& blocks) noexcept override {
    expect_levels(choice_, chunk, blocks);
  }

  void note(const NotedChunk& noted) noexcept override {
    choose_levels(choice_, noted, noted.views[decider_].eye,
                  &chosen_[static_cast<std::size_t>(noted.place - out_)]);
  }

  // The levels of the last passes' jobs, moved together as their ids were; there may be fewer than those, as
  // occlusion drops objects by themselves.
  void write(const CullerState& state, std::size_t count, const CullOutput& output) const noexcept {
    std::size_t written = 0, entries = 0;
    for (const Job& job : state.jobs) {
      if (entries >= state.entries.size()) break;
      entries += job.count, written += job.counts.written;
    }
    if (written != count) return write_each(state, count, output);
    std::size_t to = 0;
    for (const Job* job = state.jobs.data(); to < count; ++job) {
      split(&chosen_[job->first_output], job->counts.written, to, output);
      to += job->counts.written;
    }
  }

private:
  static void split(const std::uint16_t* chosen, std::size_t count, std::size_t to,
                    const CullOutput& output) {
    std::uint8_t* const levels = output.levels.data() + to;
    for (std::size_t i = 0; i < count; ++i) levels[i] = static_cast<std::uint8_t>(chosen[i]);
    if (output.fades.empty()) return;
    std::uint8_t* const fades = output.fades.data() + to;
    for (std::size_t i = 0; i < count; ++i) fades[i] = static_cast<std::uint8_t>(chosen[i] >> 8);
  }

  void write_each(const CullerState& culler, std::size_t count, const CullOutput& output) const noexcept {
    const WorldState& world = *culler.world;
    for (std::size_t i = 0; i < count; ++i) {
      const ChunkMap::Location& object = world.objects[output.ids[i]];
      const ChunkMap& map = *world.sectors[object.sector].map;
      const Lane at = lane_of(map, map.chunk(object.chunk).objects + object.slot());
      const LaneState& state = key_->sector(object.sector).pools[at.pool].states[at.lane / kLaneBlock];
      output.levels[i] = state.level[at.lane % kLaneBlock];
      if (!output.fades.empty())
        output.fades[i] = choice_.scale.fade > 0 ? state.fade[at.lane % kLaneBlock] : std::uint8_t{0};
    }
  }

  std::array<KeyLevels, kMaxViews> keys_;
  KeyLevels* key_ = nullptr;
  LaneChoice choice_;
  const ObjectId* out_ = nullptr;
  std::size_t decider_ = 0;
  geometry::LargeVector<std::uint16_t> chosen_;  // where ids stand: a level, and its fade above it
};

Status bad(const char* message) {
  return {StatusCode::bad_argument, message};
}

}  // namespace

LevelScale level_scale(const WorldView& view, const LevelOptions& options) noexcept {
  const Projector projector = make_projector(view.view, {});
  const float scale = 2 * projector.pixels_per_metre * options.scale;
  return {projector.orthographic, scale * scale, options.fade};
}

Status check_level_sizes(const LevelOptions& options, std::size_t views) noexcept {
  if (options.view >= views) return bad("cull: the levels' view is none of the views");
  if (!(options.fade >= 0) || !std::isfinite(options.fade))
    return bad("cull: the levels' fade is negative or not finite");
  if (!(options.scale > 0) || !std::isfinite(options.scale))
    return bad("cull: the levels' scale is not above 0 or not finite");
  return {};
}

std::uint8_t fade_at(float size, float end, float fade) noexcept {
  const float band = end * fade;
  const float share = band > 0 ? std::max(std::min((end + band - size) / band, 1.0f), 0.0f) : 0;
  return static_cast<std::uint8_t>(255 * share);
}

void WorldLevels::forget(ObjectId object) {
  if (object < table_of.size()) set(object, kNoLevels);
}

void WorldLevels::set(ObjectId object, LevelTableId table) {
  if (table_of[object] == table) return;
  table_of[object] = static_cast<std::uint16_t>(table);
  changed_.push_back(object);
  // Looking all up anew costs less than going through so many.
  if (edition_ != 0 && changed_.size() <= kFewChanges + table_of.size() / 32) return;
  edition_ = next_edition(), changed_.clear();
}

Status WorldLevels::check(const LevelOptions& options, std::size_t views) const noexcept {
  if (options.key >= kMaxViews) return bad("cull: the levels' key is out of range, expected 0 to 7");
  if (!(options.hysteresis >= 0 && options.hysteresis < 1))
    return bad("cull: the levels' hysteresis is out of range, expected 0 to below 1");
  return check_level_sizes(options, views);
}

void WorldLevels::begin(CullerState& state, std::span<const CullView> views, const DifferentViews& different,
                        const LevelOptions& options, const CullOutput& output) {
  if (!state.levels) state.levels = std::make_unique<RememberedLevels>();
  std::size_t decider = 0;
  while ((different.bits[decider] >> options.view & 1) == 0) ++decider;
  // Nobody else puts one there.
  auto& memory = static_cast<RememberedLevels&>(*state.levels);
  memory.begin(*this, state, output, views[options.view].view, decider, options);
  state.input.levels = &memory;
}

void WorldLevels::write(const CullerState& state, std::size_t count,
                        const CullOutput& output) const noexcept {
  static_cast<const RememberedLevels&>(*state.levels).write(state, count, output);
}

}  // namespace world

Result<LevelTableId> World::add_levels(std::span<const float> sizes) {
  if (sizes.empty() || sizes.size() >= kMaxLevels)
    return Status(StatusCode::bad_argument, "world: expected 1 to 7 sizes of levels");
  world::LevelTable table;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (!(sizes[i] > 0) || !std::isfinite(sizes[i]) || (i > 0 && sizes[i] >= sizes[i - 1]))
      return Status(StatusCode::bad_argument,
                    "world: sizes of levels do not descend, expected each below the last and above 0", i);
    table.sizes[i] = sizes[i];
  }
  if (!state_->levels) state_->levels = std::make_unique<world::WorldLevels>();
  auto& levels = static_cast<world::WorldLevels&>(*state_->levels);
  if (levels.tables.size() > world::kMostTables)
    return Status(StatusCode::too_many, "world: there are more tables of levels than 65535");
  levels.tables.push_back(table);
  return static_cast<LevelTableId>(levels.tables.size() - 1);
}

Status World::set_levels(Strided<const Handle> handles, Strided<const LevelTableId> tables) {
  if (const Status stand = world::check_handles(*this, handles); !stand) return stand;
  if (!tables.sound())
    return {StatusCode::bad_argument, "world: the tables' pointer is null or their stride too short"};
  if (tables.size() != handles.size())
    return {StatusCode::bad_argument, "world: expected one table of levels an object"};
  auto* levels = static_cast<world::WorldLevels*>(state_->levels.get());
  const std::size_t count = levels ? levels->tables.size() : 1;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (tables[i] >= count) return {StatusCode::bad_argument, "world: there is no such table of levels", i};
  }
  if (!levels) return {};  // none of them has any
  if (levels->table_of.size() < state_->objects.size()) levels->table_of.resize(state_->objects.size());
  for (std::size_t i = 0; i < handles.size(); ++i) levels->set(handles[i].index, tables[i]);
  state_->note_changed(handles);
  return {};
}

LevelTableId World::levels(Handle handle) const noexcept {
  const auto* levels = static_cast<const world::WorldLevels*>(state_->levels.get());
  if (!contains(handle) || !levels || handle.index >= levels->table_of.size()) return kNoLevels;
  return levels->table_of[handle.index];
}

}  // namespace sightline
