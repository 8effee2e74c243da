// World::move: a block of boxes at a time, with an eye on the memory that the next ones need.
#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "library/geometry/ask_ahead.hpp"
#include "library/geometry/box_math.hpp"
#include "library/geometry/box_reader.hpp"
#include "library/world/chunk_runs.hpp"
#include "library/world/world_state.hpp"

namespace sightline::world {

using geometry::kBlock;

namespace {

// What lies in it surely has its centre in the sector.
constexpr auto kInside = static_cast<float>(kSectorSide / 2);

class BlockMover {
public:
  BlockMover(WorldState& state, const Strided<const Handle>& handles, const BoxView& boxes, Moving& moving)
      : s_(state),
        handles_(handles),
        boxes_(boxes),
        moving_(moving),
        past_cache_(boxes.size() > kPastCache) {}

  void run() {
    if (handles_.size() == 0) return;
    newcomers_ = ChunkMap::kHasPages && moving_.many ? newcomers() : 0;
    begin_sector(s_.objects[handles_[0].index].sector);
    if constexpr (ChunkMap::kHasPages) {
      // In single precision boxes are as good about the point that they are given about, or where all is in
      // one sector.
      const bool float_corners = BoxReader::are_float_corners(boxes_);
      if (moving_.many && map_->keeps_pages() && (float_corners || map_->size() == s_.size) &&
          ScatteredMoves::are_scattered(handles_))
        return move_sorted(float_corners ? boxes_.origin() : s_.sectors[sector_].origin);
    }
    move_all();
  }

private:
  // As many at once as gives each page some.
  // The point by value: those of sectors move as sectors come.
  void move_sorted(WorldPoint about) {
    const Strided<const Handle> handles = handles_;
    const BoxView boxes = boxes_;
    const std::size_t at_once = s_.objects.size() / 8;
    ScatteredMoves& sorted = s_.scattered_moves();
    for (std::size_t first = 0; first < handles.size(); first += at_once) {
      const std::size_t count = std::min(at_once, handles.size() - first);
      if (sorted.sort(handles, boxes, about, first, count, s_.objects.size())) {
        handles_ = sorted.handles(), boxes_ = BoxView(sorted.boxes(), about);
      } else {
        const auto* const at = static_cast<const std::byte*>(handles.data()) + first * handles.stride();
        handles_ = {at, count, handles.stride()}, boxes_ = boxes.part(first, count);
      }
      world_first_ = kNoBlock;
      move_all();
    }
  }

  void move_all() {
    for (std::size_t first = 0; first < handles_.size(); first += kBlock) move(first);
  }

  void move(std::size_t first) {
    first_ = first;
    const auto count = static_cast<std::uint32_t>(std::min(kBlock, boxes_.size() - first));
    read_ids(count);
    if (map_ != nullptr && map_->keeps_pages() && move_by_id(count)) return;
    if (std::exchange(alone_, 0) > 0) ask_for_next();
    // A run that goes on needs nothing else of memory, not even to be told its sector.
    bool inside = runs() && read_boxes(count);
    std::uint32_t i = inside ? move_run(0, count) : 0;
    if (i == 0) {
      begin_sector(s_.objects[ids_[0]].sector);
      inside = read_boxes(count);
      if (geometry::kAsksByReading && !map_->is_mover(ids_[0])) ask_for_block(count);
    }
    while (i < count) {
      if (inside && runs()) {
        const std::uint32_t moved = move_run(i, count);
        i += moved;
        if (moved > 0) continue;
      }
      if (const std::uint32_t joined = inside ? join(i, count) : 0) {
        i += joined;
        continue;
      }
      patience_ -= patience_ > 0;
      ++alone_;
      if (!geometry::kAsksByReading) ask_ahead(first + i);
      move_one(i++, inside);
    }
  }

  // Of handles that lie side by side whole vectors at once, where that is worth its code.
  void read_ids(std::uint32_t count) {
    if constexpr (!ChunkMap::kHasPages) {
      for (std::uint32_t i = 0; i < count; ++i) ids_[i] = handles_[first_ + i].index;
    } else {
      std::array<Handle, kBlock> copies;
      const std::span<const Handle> handles = side_by_side(handles_, first_, std::span(copies).first(count));
      for (std::uint32_t i = 0; i < count; ++i) ids_[i] = handles[i].index;
    }
  }

  [[nodiscard]] bool runs() const { return run_chunk_ != ChunkMap::kNone && patience_ == 0; }
  std::uint32_t move_run(std::uint32_t i, std::uint32_t count) {
    const std::uint32_t moved =
        map_->move_run(run_chunk_, run_slot_, &ids_[i], block_, i, count - i, past_cache_);
    if (moved < kWorthARun && run_slot_ > 0) patience_ = kFruitless;
    return moved;
  }

  // Of all to be moved, about how many stand still.
  [[nodiscard]] std::size_t newcomers() const {
    constexpr std::size_t kAsked = 64;
    const std::size_t step = std::max<std::size_t>(1, handles_.size() / kAsked);
    std::size_t asked = 0, still = 0;
    for (std::size_t i = 0; i < handles_.size(); i += step, ++asked)
      still += !s_.objects[handles_[i].index].moves();
    return handles_.size() * still / asked;
  }

  // Where many move at once: how many from i on have only now begun to.
  std::uint32_t join(std::uint32_t i, std::uint32_t count) {
    if (!ChunkMap::kHasPages || !moving_.many) return 0;
    if (i == 0) ask_for_next();
    return map_->join_movers(&ids_[i], sector_, block_, i, count - i);
  }

  void begin_sector(std::uint32_t sector) {
    s_.touch(sector);
    if (sector == sector_ && map_ == s_.sectors[sector].map.get()) return;
    sector_ = sector, map_ = s_.sectors[sector].map.get();
    map_->expect_moves(moving_.many, newcomers_);
    run_chunk_ = ChunkMap::kNone;
  }

  // The same where movers stand in pages, of the sector that the last block began in. False, with nothing
  // done, where this one begins elsewhere.
  bool move_by_id(std::uint32_t count) {
    const Box* const boxes = structs(count);
    if (std::exchange(came_, 0) > 0) ask_for_next();
    // What lies close together is fetched by itself.
    const std::uint32_t part = lie_apart(count) ? kPart : count;
    for (std::uint32_t first = 0; first < count; first += part) {
      if (part == kPart) ask_for_pages(first_ + first + kPart);
      if (!move_by_id(boxes, first, std::min(first + part, count))) return false;
    }
    return true;
  }

  bool move_by_id(const Box* boxes, std::uint32_t first, std::uint32_t end) {
    const std::span<const ObjectId> ids(ids_.data(), end);
    for (std::uint32_t i = first; i < end; ++i) {
      i += map_->move_in_pages(ids.subspan(i), boxes + i, kInSector, sector_, moving_.many, came_);
      if (i == end) break;
      if (i == 0 && s_.objects[ids[0]].sector != sector_) return false;
      ++came_;
      s_.objects[ids[i]].sector == sector_&& geometry::holds(kInSector, boxes[i])
          ? map_->move_loosely(ids[i], boxes[i], moving_)
          : move_anywhere(ids[i], world_box(i));
    }
    return true;
  }

  // The block's boxes about the sector's origin, one after another.
  const Box* structs(std::uint32_t count) {
    const WorldPoint& origin = s_.sectors[sector_].origin;
    std::span<const Box> structs;
    if (BoxReader::lies_as_structs(boxes_, origin, structs)) return structs.data() + first_;
    BoxReader::lay_out(boxes_, first_, count, origin, block_);
    for (std::uint32_t i = 0; i < count; ++i) laid_out_[i] = box_of_block(i);
    return laid_out_.data();
  }
  [[nodiscard]] Box box_of_block(std::uint32_t i) const {
    const auto& v = block_.values;
    return {{v[0][i], v[1][i], v[2][i]}, {v[3][i], v[4][i], v[5][i]}};
  }

  [[nodiscard]] bool lie_apart(std::uint32_t count) const {
    constexpr std::size_t kDense = 32;  // ids an object
    return ids_[count - 1] < ids_[0] || ids_[count - 1] - ids_[0] >= kDense * count;
  }

  // For some objects to come.
  void ask_for_pages(std::size_t at) const {
    std::array<ObjectId, kPart> ids;
    const std::size_t count = std::min<std::size_t>(kPart, handles_.size() - std::min(at, handles_.size()));
    for (std::size_t i = 0; i < count; ++i) ids[i] = handles_[at + i].index;
    map_->prefetch_pages({ids.data(), count});
  }

  // Of the objects of the next block.
  void ask_for_next() const {
    if (geometry::kAsksByReading) return;
    const std::size_t end = std::min(first_ + 2 * kBlock, handles_.size());
    for (std::size_t i = first_ + kBlock; i < end; ++i) geometry::ask_ahead(&s_.objects[handles_[i].index]);
  }

  // Returns whether all surely have their centres in the sector.
  bool read_boxes(std::uint32_t count) {
    return lay_out_in_sector(boxes_, first_, count, s_.sectors[sector_].origin, block_);
  }

  // What objects need is asked for in three steps, each when the one before has arrived.
  void ask_ahead(std::size_t at) const {
    constexpr std::size_t kLanes = 8, kChunk = 16, kObject = 32;
    if (at + kObject >= handles_.size()) return;
    geometry::ask_ahead(&s_.objects[handles_[at + kObject].index]);
    ask_for_chunk(handles_[at + kChunk].index);
    ask_for_lanes(handles_[at + kLanes].index);
  }
  void ask_for_block(std::uint32_t count) const {
    const std::span<const ObjectId> ids(ids_.data(), count);
    for (const ObjectId id : ids) geometry::ask_ahead(&s_.objects[id]);
    for (const ObjectId id : ids) ask_for_chunk(id);
    for (const ObjectId id : ids) ask_for_lanes(id);
  }
  void ask_for_chunk(ObjectId id) const {
    if (stays(id)) map_of(id).prefetch_chunk(id);
  }
  void ask_for_lanes(ObjectId id) const {
    if (stays(id)) map_of(id).prefetch_lanes(id);
  }
  // Of what is about to leave its chunk, the map asks by itself.
  [[nodiscard]] bool stays(ObjectId id) const {
    return !ChunkMap::kHasPages || !moving_.many || s_.objects[id].moves();
  }
  [[nodiscard]] ChunkMap& map_of(ObjectId id) const { return *s_.sectors[s_.objects[id].sector].map; }

  void move_one(std::uint32_t i, bool inside) {
    const ObjectId id = ids_[i];
    if (!inside || s_.objects[id].sector != sector_) return move_anywhere(id, world_box(i));
    map_->move_loosely(id, box_of_block(i), moving_);
    expect_next(id);
  }

  void expect_next(ObjectId id) {
    const ChunkMap::Location& at = map_->location(id);
    run_chunk_ = map_->is_mover(id) ? at.chunk : ChunkMap::kNone;
    run_slot_ = at.slot() + 1u;
  }

  // The block's boxes as they were given, read when the first of them is asked for.
  const WorldBox& world_box(std::uint32_t i) {
    if (world_first_ != first_) {
      const std::size_t count = std::min(kBlock, boxes_.size() - first_);
      BoxReader::read(boxes_, first_, count, world_boxes_.data(), true);
      world_first_ = first_;
    }
    return world_boxes_[i];
  }

  void move_anywhere(ObjectId id, const WorldBox& box) {
    const std::uint32_t from = s_.objects[id].sector;
    const Box here = geometry::relative_box(box, s_.sectors[from].origin);
    s_.touch(from);
    run_chunk_ = ChunkMap::kNone;
    const std::uint32_t to = geometry::holds(kInSector, here) ? from : s_.sector_at(sector_cell(box));
    if (to == from) return s_.sectors[from].map->move_loosely(id, here, moving_);
    s_.touch(to);
    s_.sectors[from].map->remove(id);
    s_.sectors[to].map->insert_moving(id, geometry::relative_box(box, s_.sectors[to].origin));
    s_.objects[id].sector = to;
    map_ = s_.sectors[sector_].map.get();
  }

  WorldState& s_;
  Strided<const Handle> handles_;
  BoxView boxes_;
  Moving& moving_;
  std::size_t newcomers_ = 0;                         // about how many of all stand still
  static constexpr std::size_t kPastCache = 400'000;  // boxes of 24 bytes
  bool past_cache_;
  std::size_t first_ = 0;
  static constexpr float kJustInside = kInside - 0.001f;
  static constexpr Box kInSector{{-kJustInside, -kJustInside, -kJustInside},
                                 {kJustInside, kJustInside, kJustInside}};
  // A run that ends at once was not worth looking for: then some objects are moved one by one.
  static constexpr std::uint32_t kWorthARun = 4, kFruitless = 16;
  // So many objects in pages far apart are asked for while as many before them are moved.
  static constexpr std::uint32_t kPart = 16;
  std::uint32_t patience_ = 0;
  std::uint32_t sector_ = ChunkMap::kNone;
  ChunkMap* map_ = nullptr;
  // Of the last block, objects that did not stand in their pages; that were neither in a run nor joined.
  std::uint32_t came_ = 1, alone_ = 1;
  // Where the next object stands if they are listed as they stand.
  std::uint32_t run_chunk_ = ChunkMap::kNone, run_slot_ = 0;
  std::array<ObjectId, kBlock> ids_;
  geometry::BoxBlock block_;
  std::array<Box, kBlock> laid_out_;
  std::array<WorldBox, kBlock> world_boxes_;
  static constexpr auto kNoBlock = static_cast<std::size_t>(-1);
  std::size_t world_first_ = kNoBlock;  // of which block
};

}  // namespace

bool lay_out_in_sector(const BoxView& boxes, std::size_t first, std::size_t count, const WorldPoint& origin,
                       geometry::BoxBlock& out) noexcept {
  std::span<const Box> structs;
  if (BoxReader::lies_as_structs(boxes, origin, structs))
    return lay_out_structs(structs.subspan(first, count), out) < kInside;
  BoxReader::lay_out(boxes, first, count, origin, out);
  unsigned outside = 0;
  for (const auto& side : out.values) {
    for (std::size_t i = 0; i < count; ++i) outside |= unsigned{!(std::fabs(side[i]) < kInside)};
  }
  return outside == 0;
}

ScatteredMoves& WorldState::scattered_moves() {
  if (!scattered) scattered = std::make_unique<ScatteredMoves>();
  return *scattered;
}

bool WorldState::begin_frame() {
  if (!culled.load(std::memory_order_relaxed)) return false;
  culled.store(false, std::memory_order_relaxed);
  ++tick;
  return true;
}

void WorldState::let_rest() {
  // Of many sectors, some a frame.
  for (std::size_t left = std::min(awake.size(), kFewestAtRest + awake.size() / 16); left > 0; --left) {
    if (awake_hand >= awake.size()) awake_hand = 0;
    Sector& sector = sectors[awake[awake_hand]];
    if (sector.map && sector.map->restless()) {
      touch(awake[awake_hand++]);
      sector.map->rest();
      continue;
    }
    sector.awake = false;
    awake[awake_hand] = awake.back();
    awake.pop_back();
  }
}

void WorldState::move(const Strided<const Handle>& handles, const BoxView& boxes) {
  const bool new_frame = begin_frame();
  constexpr std::size_t kManyOf = 16, kOftenOf = 64;
  const std::size_t count = boxes.size();
  Moving moving{tick, kManyOf * count >= size, allowance};
  moving.allowance += static_cast<std::uint32_t>(count / kOftenOf);
  if (new_frame) moving.allowance = static_cast<std::uint32_t>(count / kOftenOf) + kFewestAtRest;
  BlockMover(*this, handles, boxes, moving).run();
  hwy::FlushStream();  // what went past the cache is there before anybody on another thread is told to look
  allowance = moving.allowance;
  for (const std::uint32_t t : touched) {
    Sector& sector = sectors[t];
    sector.map->flush();
    if (sector.awake || !sector.map->restless()) continue;
    sector.awake = true;
    awake.push_back(t);
  }
  if (new_frame) let_rest();
  tidy(false);
}

}  // namespace sightline::world
