#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <sightline/projection.hpp>

#include "library/geometry/ask_ahead.hpp"
#include "library/geometry/mutant.h"
#include "library/world/culler_state.hpp"
#include "library/world/levels.hpp"

namespace sightline {

namespace world {

namespace {

constexpr std::size_t kMostTables = 65535;

// One frame of one key: who decides, and what is known of each object.
class Choice final : public LevelNotes {
public:
  void begin(const WorldLevels& levels, geometry::LargeVector<KnownLevel>& known, std::uint16_t cull,
             const WorldView& view, std::size_t decider, const LevelOptions& options) {
    levels_ = &levels, known_ = known.data(), cull_ = cull, decider_ = decider;
    // A cull has passes of its own for what automatic occlusion leaves: their objects were noted by the
    // first.
    last_ = options.cut ? cull : static_cast<std::uint16_t>(cull - 1);
    scale_ = level_scale(view, options);
    finer_ = 1 + options.hysteresis, coarser_ = 1 - options.hysteresis;
    if (SIGHTLINE_MUTANT(levels_without_memory)) finer_ = coarser_ = 1;
  }

  void note(const ChunkMap::ChunkView& chunk, const SectorView* views, const ObjectId* ids,
            std::size_t count) noexcept override {
    // Ids of neighbours in space may lie anywhere: memory is what this waits for, so all is asked for first.
    for (const ObjectId id : std::span(ids, count)) {
      geometry::ask_ahead(known_ + id);
      if (id < levels_->table_of.size()) geometry::ask_ahead(&levels_->table_of[id]);
    }
    alignas(64) std::array<float, ChunkMap::kCapacity> sizes;
    const std::size_t by = SIGHTLINE_MUTANT(levels_by_each_view) ? 0 : decider_;
    find_sizes(chunk, views[by].eye, scale_.orthographic, scale_.squared, sizes.data());
    std::size_t slot = 0;
    for (const ObjectId id : std::span(ids, count)) {
      while (chunk.objects[slot] != id) ++slot;
      choose(id, sizes[slot]);
    }
  }

private:
  void choose(ObjectId id, float size) noexcept {
    KnownLevel& known = known_[id];
    const auto& limits = levels_->table(id).sizes;
    // Objects that were seen keep their level until the size is well beyond its limits. Without branches,
    // which nobody could predict.
    const bool seen = known.cull != 0 && (known.cull == last_ || known.cull == cull_);
    const float finer = seen ? finer_ : 1, coarser = seen ? coarser_ : 1;
    std::uint32_t least = 0, most = 0;
    for (const float limit : limits) least += size < limit * coarser, most += size < limit * finer;
    const std::uint32_t level = std::max(std::min<std::uint32_t>(known.level, most), least);
    known = {cull_, static_cast<std::uint8_t>(level), fade_at(size, limits[level] * finer_, scale_.fade)};
  }

  const WorldLevels* levels_ = nullptr;
  KnownLevel* known_ = nullptr;
  std::uint16_t cull_ = 0, last_ = 0;
  std::size_t decider_ = 0;
  LevelScale scale_;
  float finer_ = 1, coarser_ = 1;
};

// By key, as the culls of a key follow one another.
class RememberedLevels final : public LevelMemory {
public:
  LevelNotes* begin(const WorldLevels& levels, std::size_t ids, const WorldView& view, std::size_t decider,
                    const LevelOptions& options) {
    OfKey& key = keys_[options.key];
    if (key.known.size() < ids) key.known.resize(ids);
    if (key.cull == std::numeric_limits<std::uint16_t>::max()) {
      std::fill(key.known.begin(), key.known.end(), KnownLevel{});
      key.cull = 0;
    }
    ++key.cull;
    last_ = &key;
    choice_.begin(levels, key.known, key.cull, view, decider, options);
    return &choice_;
  }

  [[nodiscard]] std::span<const KnownLevel> known() const { return last_->known; }

private:
  struct OfKey {
    geometry::LargeVector<KnownLevel> known;  // one an id
    std::uint16_t cull = 0;                   // counts culls
  };
  std::array<OfKey, kMaxViews> keys_;
  OfKey* last_ = nullptr;
  Choice choice_;
};

Status bad(const char* message) {
  return {StatusCode::bad_argument, message};
}

Status check_levels(const LevelOptions& options, std::size_t views) {
  if (options.key >= kMaxViews) return bad("cull: the levels' key is out of range, expected 0 to 7");
  if (!(options.hysteresis >= 0 && options.hysteresis < 1))
    return bad("cull: the levels' hysteresis is out of range, expected 0 to below 1");
  return check_level_sizes(options, views);
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

void WorldLevels::forget(ObjectId object) noexcept {
  if (object < table_of.size()) table_of[object] = 0;
}

Status WorldLevels::begin(CullerState& state, std::span<const CullView> views,
                          const DifferentViews& different, const LevelOptions& options,
                          const CullOutput& output) {
  for (const auto& bytes : {output.levels, output.fades})
    if (!bytes.empty() && bytes.size() < state.world->size)
      return {StatusCode::buffer_too_small,
              "cull: expected room for cull_capacity() levels and fades, or none"};
  if (const Status sound = check_levels(options, views.size()); !sound) return sound;
  if (!state.levels) state.levels = std::make_unique<RememberedLevels>();
  std::size_t decider = 0;
  while ((different.bits[decider] >> options.view & 1) == 0) ++decider;
  // Nobody else puts one there.
  auto& memory = static_cast<RememberedLevels&>(*state.levels);
  state.input.levels =
      memory.begin(*this, state.world->objects.size(), views[options.view].view, decider, options);
  return {};
}

void WorldLevels::write(const CullerState& state, std::size_t count,
                        const CullOutput& output) const noexcept {
  const auto known = static_cast<const RememberedLevels&>(*state.levels).known();
  const auto ids = output.ids.first(count);
  const auto fades = output.fades;
  for (std::size_t i = 0; i < count; ++i) {
    const KnownLevel& level = known[ids[i]];
    output.levels[i] = level.level;
    if (!fades.empty()) fades[i] = level.fade;
  }
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
  if (!tables.sound() || tables.size() != handles.size())
    return {StatusCode::bad_argument, "world: expected one table of levels an object"};
  auto* levels = static_cast<world::WorldLevels*>(state_->levels.get());
  const std::size_t count = levels ? levels->tables.size() : 1;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (tables[i] >= count) return {StatusCode::bad_argument, "world: there is no such table of levels", i};
  }
  if (!levels) return {};  // none of them has any
  if (levels->table_of.size() < state_->objects.size()) levels->table_of.resize(state_->objects.size());
  for (std::size_t i = 0; i < handles.size(); ++i)
    levels->table_of[handles[i].index] = static_cast<std::uint16_t>(tables[i]);
  state_->note_changed(handles);
  return {};
}

LevelTableId World::levels(Handle handle) const noexcept {
  const auto* levels = static_cast<const world::WorldLevels*>(state_->levels.get());
  if (!contains(handle) || !levels || handle.index >= levels->table_of.size()) return kNoLevels;
  return levels->table_of[handle.index];
}

}  // namespace sightline
