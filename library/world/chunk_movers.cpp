// Moving at little cost: within a chunk's bounds a move touches nothing but its box; what leaves them, or
// moves frame after frame, stands in chunks of movers, in the order in which it came, until it rests.
#include <algorithm>
#include <bit>
#include <utility>

#include "library/geometry/ask_ahead.hpp"
#include "library/geometry/box_math.hpp"
#include "library/world/chunk_map.hpp"
#include "library/world/chunk_runs.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

// No key's number: movers have none.
constexpr std::uint32_t kMoverKey = 0xfffffffeu;

float longest_side(const Box& b) {
  return std::max({b.max.x - b.min.x, b.max.y - b.min.y, b.max.z - b.min.z});
}

// Whether an object that moves now has done so in most of the last frames.
bool moves_often(ChunkMap::Location& at, std::uint16_t tick) {
  constexpr int kOften = 4;  // of 8
  const std::uint32_t before = at.slot_and_history;
  const auto since = static_cast<std::uint16_t>(tick - (before >> 16));
  const std::uint32_t history = since >= 8 ? 1 : ((before >> 8 & 0xff) << since | 1) & 0xff;
  at.slot_and_history = std::uint32_t{tick} << 16 | history << 8 | (before & 0xff);
  return std::popcount(history) >= kOften;
}

}  // namespace

// Room for moves to come: small beside the box, so that culling hardly sees it.
Box ChunkMap::widened(const Box& b) noexcept {
  constexpr float kSlack = 0.125f;
  const float by = kSlack * longest_side(b);
  return {{b.min.x - by, b.min.y - by, b.min.z - by}, {b.max.x + by, b.max.y + by, b.max.z + by}};
}

bool ChunkMap::keeps_movers() const noexcept {
  constexpr std::size_t kFewest = 1024;
  return size_ >= kFewest;
}

void ChunkMap::move_loosely(ObjectId object, const Box& box, Moving& moving) {
  loosely_ = true;
  Location& at = (*locations_)[object];
  const bool for_movers = keeps_movers(), at_once = for_movers && moving.many && !at.moves();
  if (kHasPages && at_once) {
    leave_soon(object);
    add_mover(object, box);
    ++joined_, ++woken_;
    return;
  }
  Chunk& c = chunks_[at.chunk];
  if (c.pool == kMovers && keeps_pages() && !is_page(c)) {
    leave(at.chunk, at.slot());
    return add_mover(object, box);
  }
  if (c.pool == kMovers) return move_mover(at.chunk, at.slot(), box);
  if (at_once || (for_movers && moves_often(at, moving.tick) && moving.allowance > 0)) {
    moving.allowance -= !at_once;
  } else if (holds(c.bounds, box)) {
    write_box(c, at.slot(), box);
    c.moved[0] = 1;
    return;
  } else if (!for_movers) {
    return move(object, box);
  } else if (const Box wide = widened(c.bounds); !c.wide && holds(wide, box)) {
    c.bounds = wide, c.wide = true;
    make_dirty(at.chunk), note_grown(at.chunk);
    write_box(c, at.slot(), box);
    c.moved[0] = 1;
    return;
  }
  leave(at.chunk, at.slot());
  add_mover(object, box);
  ++joined_, ++woken_;
}

void ChunkMap::insert_moving(ObjectId object, const Box& box) {
  if (!keeps_movers()) return insert(object, box);
  loosely_ = true;
  add_mover(object, box);
  ++size_;
}

void ChunkMap::move_mover(std::uint32_t chunk, std::uint32_t slot, const Box& box) {
  Chunk& c = chunks_[chunk];
  ++scattered_;
  if (!holds(c.bounds, box)) {
    c.bounds = widened(united(c.bounds, box));
    make_dirty(chunk);
  }
  write_box(c, slot, box);
  std::uint64_t& word = c.moved[slot / 64];
  woken_ += ~word >> slot % 64 & 1;
  word |= std::uint64_t{1} << slot % 64;
}

// What the group holds of a chunk.
void ChunkMap::prefetch_group(const Chunk& c) const noexcept {
  if (c.group == kNone) return;
  const Group& group = groups_[c.group];
  for (const auto& side : group.bounds) ask_ahead(&side[c.index_in_group]);
  ask_ahead(&group.count_and_size[c.index_in_group]), ask_ahead(&group.box);
}

void ChunkMap::prefetch_chunk(ObjectId object) const noexcept {
  const std::uint32_t chunk = (*locations_)[object].chunk;
  if (chunk < chunks_.size()) ask_ahead(&chunks_[chunk]);
}

void ChunkMap::prefetch_lanes(ObjectId object) const noexcept {
  const Location& at = (*locations_)[object];
  if (at.chunk >= chunks_.size()) return;
  const Chunk& c = chunks_[at.chunk];
  if (at.slot() >= c.capacity) return;
  for (std::uint32_t side = 0; side < 6; ++side) ask_ahead(lanes(c, side) + at.slot());
}

void ChunkMap::make_dirty(std::uint32_t chunk) {
  if (chunks_[chunk].dirty) return;
  chunks_[chunk].dirty = true;
  dirty_.push_back(chunk);
}

void ChunkMap::note_grown(std::uint32_t chunk) {
  if (chunks_[chunk].grown) return;
  chunks_[chunk].grown = true;
  grown_.push_back(chunk);
}

// Makes a hole of a slot.
void ChunkMap::leave(std::uint32_t chunk, std::uint32_t slot) {
  Chunk& c = chunks_[chunk];
  ids(c)[slot] = kNoObject;
  --c.live, ++changes_[c.pool];
  make_dirty(chunk);
  if (has_columns()) note_stale(chunk);
  if (c.pool == kMovers) {
    c.moved[slot / 64] &= ~(std::uint64_t{1} << slot % 64);
  } else {
    c.moved[0] = 1;
    note_grown(chunk);
  }
}

// Where the lanes begin of the movers' chunk so many chunks behind the one whose lanes begin there.
std::uint32_t ChunkMap::lane_after(std::uint32_t lane, std::uint32_t chunks) noexcept {
  constexpr std::uint32_t kChunks = kRowLanes / kCapacity;
  chunks += lane % kRowLanes / kCapacity;
  return (lane / kRowLanes + chunks / kChunks) * kRowLanes + chunks % kChunks * kCapacity;
}

// Room in rows for so many lanes. Rows that begin alike within a small page are in one another's way in the
// cache.
void ChunkMap::make_rows(Pool& pool, std::size_t lanes) {
  constexpr std::size_t kPage = 1024, kApart = 7 * kLanes, kLongest = kRowLanes + kApart;  // floats
  const std::size_t old_row = pool.row, wanted = std::max(lanes, 2 * old_row);
  const bool longer = old_row < kLongest && lanes > old_row;
  if (longer) pool.row = std::min(kLongest, (wanted + kPage - 1) / kPage * kPage + kApart);
  const std::size_t size = (lanes + kRowLanes - 1) / kRowLanes * 6 * pool.row;
  if (!longer) return pool.lanes.resize(std::max(size, pool.lanes.size()));
  geometry::UnwrittenVector<float> rows(size);
  for (std::size_t side = 0; side < 6; ++side)
    std::copy_n(pool.lanes.begin() + side * old_row, old_row, rows.begin() + side * pool.row);
  pool.lanes = std::move(rows);
}

std::uint32_t ChunkMap::add_mover_chunk(std::uint32_t first_lane) {
  if (mover_node_ == kNone) {
    mover_node_ = static_cast<std::uint32_t>(nodes_.size());
    Node& node = nodes_.emplace_back();
    node.parent = 0, node.bounds = kEmptyBox;
    loose_.push_back(0);
  }
  Pool& pool = pools_[kMovers];
  if (pool.ids.empty()) {
    // For those who come at once. A few shall not wait for large pages of memory.
    const std::size_t all = size_ + size_ / 16 + 4 * kCapacity,
                      first = std::max<std::size_t>(newcomers_ + newcomers_ / 16, kRowLanes),
                      room = kHasPages ? std::min(all, first) : all;
    pool.ids.reserve(room);
    kHasPages ? make_rows(pool, room) : pool.lanes.reserve(6 * room);
  }
  const std::uint32_t added = add_chunk(kMoverKey, kCapacity, kEmptyBox, kMovers, first_lane);
  chunks_[added].parent = static_cast<std::uint32_t>(mover_chunks_.size());
  mover_chunks_.push_back(added);
  return added;
}

// The chunk that takes the next mover.
std::uint32_t ChunkMap::open_mover_chunk() {
  if (open_ != kNone && chunks_[open_].count < kCapacity) return open_;
  const std::uint32_t added = add_mover_chunk();
  if (open_ != kNone) chunks_[open_].next = added;
  return open_ = added;
}

// Of the first pages, whose lanes stay theirs.
bool ChunkMap::is_kept_page(const Chunk& c) const noexcept {
  return c.pool == kMovers && is_page(c) && c.previous < kept_pages_;
}

// The chunk of an id's page.
std::uint32_t ChunkMap::open_page(ObjectId object) {
  const std::uint32_t page = object / kCapacity;
  if (page >= pages_.size())
    pages_.resize(std::max<std::size_t>(page, locations_->size() / kCapacity) + 1, kNone);
  if (page_lane_ == kNone) {
    kept_pages_ = static_cast<std::uint32_t>(pages_.size());
    page_lane_ = add_lanes(pools_[kMovers], kept_pages_ * kCapacity);
  }
  if (pages_[page] != kNone) return pages_[page];
  const std::uint32_t added = pages_[page] =
      add_mover_chunk(page < kept_pages_ ? lane_after(page_lane_, page) : kNone);
  new_pages_.push_back(page);
  Chunk& c = chunks_[added];
  c.previous = page, c.count = kCapacity;
  std::fill_n(ids(c), kCapacity, kNoObject);
  return added;
}

void ChunkMap::expect_moves(bool many, std::size_t newcomers) noexcept {
  // Where few move, each cull would read all pages for them; where the same ones move again and again in the
  // order in which they stand, they stand well. Others each time show as newcomers while some move already,
  // or as such when movers move again.
  constexpr std::size_t kFewest = 6;  // of all ids
  const std::size_t enough = locations_->size() / kFewest;
  const bool others = movers() > 0 && 4 * newcomers > movers(),
             unordered = scattered_ + in_runs_ > 0 && 2 * (scattered_ + joined_) > in_runs_;
  by_id_ =
      kHasPages && keeps_movers() &&
      (by_id_ ? movers() >= enough
              : many && ((others && movers() + newcomers >= enough) || (unordered && movers() >= enough)));
  scattered_ = in_runs_ = joined_ = 0;
  newcomers_ = newcomers;
}

// Of an object of the map that stands elsewhere.
void ChunkMap::come_to_page(ObjectId object) {
  loosely_ = true;
  leave_soon(object);
  const std::uint32_t chunk = open_page(object), slot = object % kCapacity;
  Chunk& c = chunks_[chunk];
  ++c.live, ++joined_, ++woken_;
  ids(c)[slot] = object;
  Location& at = (*locations_)[object];
  at.chunk = chunk, at.slot_and_history = (at.slot_and_history & ~0xffu) | Location::kMoves | slot;
  if (has_columns()) load_columns(c, slot), note_stale(chunk);
  make_dirty(chunk);
}

std::uint32_t ChunkMap::move_in_pages(std::span<const ObjectId> objects, const Box* boxes, const Box& within,
                                      std::uint32_t sector, bool many, std::uint32_t& came) {
  const auto stands_in_page = [&](ObjectId object) {
    const std::uint32_t page = object / kCapacity;
    return page < pages_.size() && pages_[page] != kNone &&
           ids(chunks_[pages_[page]])[object % kCapacity] == object;
  };
  ++changes_[kMovers];
  std::uint32_t i = 0;
  while (i < objects.size()) {
    const std::uint32_t page = objects[i] / kCapacity;
    const std::uint32_t written = write_in_page_of(page, objects.subspan(i), boxes + i, within);
    i += written;
    if (i == objects.size() || (written > 0 && objects[i] / kCapacity != page)) continue;
    // The next one does not stand in its page, or leaves the bounds of it.
    if (!holds(within, boxes[i])) return i;
    if (!stands_in_page(objects[i])) {
      const Location& place = (*locations_)[objects[i]];
      if (place.sector != sector || !(many || place.moves())) return i;
      come_to_page(objects[i]);
      ++came;
    }
    Chunk& c = chunks_[pages_[page]];
    if (holds(c.bounds, boxes[i])) continue;
    c.bounds = widened(united(c.bounds, boxes[i]));
    make_dirty(pages_[page]);
  }
  return i;
}

// Writes the boxes of objects while they stand in this page and need no more of its bounds.
std::uint32_t ChunkMap::write_in_page_of(std::uint32_t page, std::span<const ObjectId> objects,
                                         const Box* boxes, const Box& within) noexcept {
  if (!kHasPages || page >= pages_.size() || pages_[page] == kNone) return 0;
  // For the page after this one.
  const bool goes_on = objects.back() > objects.front() && objects.back() - objects.front() < 32 * kCapacity;
  if (goes_on && page + 1 < pages_.size() && pages_[page + 1] != kNone) ask_ahead(&chunks_[pages_[page + 1]]);
  Chunk& c = chunks_[pages_[page]];
  return write_in_page({c.bounds, within, page * kCapacity, c.live == kCapacity ? nullptr : ids(c),
                        lanes(c, 0), step(c), c.moved.data(), woken_},
                       objects, boxes);
}

void ChunkMap::prefetch_pages(std::span<const ObjectId> objects) const noexcept {
  const Pool& pool = pools_[kMovers];
  const bool all_full = movers() == size_;
  for (const ObjectId object : objects) {
    const std::uint32_t page = object / kCapacity;
    if (page >= kept_pages_ || pages_[page] == kNone) continue;
    // As the page's chunk says, which is not here yet.
    const std::size_t lane = lane_after(page_lane_, page) + object % kCapacity;
    const float* const box = pool.lanes.data() + pool.begin(lane);
    ask_ahead(&chunks_[pages_[page]]);
    for (std::size_t side = 0; side < 6; ++side) ask_ahead(box + side * pool.row);
    if (!all_full) ask_ahead(pool.ids.data() + lane);
  }
}

void ChunkMap::free_mover_chunk(std::uint32_t chunk) {
  const Chunk& c = chunks_[chunk];
  mover_chunks_[c.parent] = mover_chunks_.back();
  chunks_[mover_chunks_.back()].parent = c.parent;
  mover_chunks_.pop_back();
  if (is_page(c)) pages_[c.previous] = kNone;
  if (chunk == open_) open_ = kNone;
  free_chunk(chunk);
}

void ChunkMap::add_mover(ObjectId object, const Box& box) {
  const bool in_page = keeps_pages();
  const std::uint32_t chunk = in_page ? open_page(object) : open_mover_chunk();
  Chunk& c = chunks_[chunk];
  const std::uint32_t slot = in_page ? object % kCapacity : c.count++;
  ++c.live;
  write(chunk, slot, object, box);
  c.moved[slot / 64] |= std::uint64_t{1} << slot % 64;
  if (!holds(c.bounds, box)) c.bounds = united(c.bounds, box);
  make_dirty(chunk);
}

// Groups have new pages in the order of their lanes, in whichever their objects came: who culls them reads
// memory from the front to the back.
void ChunkMap::file_new_pages() {
  if (!kHasPages) return;
  std::sort(new_pages_.begin(), new_pages_.end());
  for (const std::uint32_t page : new_pages_) {
    const std::uint32_t chunk = pages_[page];
    if (chunk != kNone && chunks_[chunk].group == kNone) put_in_group(chunk, kNone, chunks_[chunk].bounds);
  }
  new_pages_.clear();
}

void ChunkMap::flush() {
  leave_now();
  file_new_pages();
  // In three steps, each when the one before has arrived.
  constexpr std::size_t kGroup = 8, kChunk = 16;
  for (std::size_t i = 0; i < dirty_.size(); ++i) {
    if (kHasPages && i + kChunk < dirty_.size()) prefetch_lines(chunks_[dirty_[i + kChunk]]);
    if (kHasPages && i + kGroup < dirty_.size()) prefetch_group(chunks_[dirty_[i + kGroup]]);
    const std::uint32_t chunk = dirty_[i];
    Chunk& c = chunks_[chunk];
    c.dirty = false;
    if (c.key == kNone) continue;  // it was freed
    if (c.group == kNone) {
      put_in_group(chunk, kNone, c.bounds);
      continue;
    }
    if (c.pool == kMovers && c.live == 0 && (chunk != open_ || c.count == kCapacity)) {
      add_objects(c.group, -static_cast<std::int32_t>(c.counted));
      free_mover_chunk(chunk);
      continue;
    }
    set_bounds(chunk, c.bounds);
    extend_group(c.group, c.bounds);
    note_change(chunk);
    if (c.counted == c.live) continue;
    add_objects(c.group, static_cast<std::int32_t>(c.live) - static_cast<std::int32_t>(c.counted));
    c.counted = c.live;
  }
  dirty_.clear();
}

// --- rest ---

void ChunkMap::rest() {
  flush();
  rest_grown();
  auto budget = static_cast<std::uint32_t>(movers() / kRound) + 64;
  for (std::size_t left = (mover_chunks_.size() + kRound - 1) / kRound; left > 0 && !mover_chunks_.empty();
       --left) {
    if (mover_hand_ >= mover_chunks_.size()) mover_hand_ = 0;
    const std::uint32_t chunk = mover_chunks_[mover_hand_];
    if (!rest_movers(chunk, budget)) break;
    // Where it was given up another has come in its place.
    if (mover_hand_ < mover_chunks_.size() && mover_chunks_[mover_hand_] == chunk) ++mover_hand_;
  }
  woken_ = 0;
  flush();
}

// Visits the next of the still chunks with wide bounds or holes.
void ChunkMap::rest_grown() {
  constexpr std::size_t kVisits = 64;  // a part of all
  for (std::size_t left = (grown_.size() + kVisits - 1) / kVisits; left > 0; --left) {
    if (grown_hand_ >= grown_.size()) grown_hand_ = 0;
    const std::uint32_t chunk = grown_[grown_hand_];
    Chunk& c = chunks_[chunk];
    const bool stands = c.key != kNone && c.pool == kStill;
    if (stands && c.moved[0] != 0) {
      c.moved[0] = 0;
      ++grown_hand_;
      continue;
    }
    c.grown = false;
    grown_[grown_hand_] = grown_.back();
    grown_.pop_back();
    if (stands) tighten_grown(chunk);
  }
}

void ChunkMap::tighten_grown(std::uint32_t chunk) {
  Chunk& c = chunks_[chunk];
  c.wide = false;
  if (c.live == 0) return unlink(chunk);
  const Box before = c.bounds;
  set_bounds(chunk, tight(c));
  shrink_group(c.group, before);
  try_merge(chunk);
}

// Files those of a chunk's movers that rested since the last visit, as far as the budget goes; false where it
// ended.
bool ChunkMap::file_rested(std::uint32_t chunk, std::uint32_t& budget) {
  for (std::uint32_t slot = 0; slot < chunks_[chunk].count; ++slot) {
    const Chunk& c = chunks_[chunk];
    const ObjectId object = ids(c)[slot];
    if (object == kNoObject || (c.moved[slot / 64] >> slot % 64 & 1)) continue;
    if (budget == 0) return false;
    --budget;
    const Box box = box_at(c, slot);
    leave(chunk, slot);
    (*locations_)[object].slot_and_history = 0;
    file(object, box);
  }
  return true;
}

// Visits a chunk of movers; false where the budget ended. A chunk of few is given up, and its movers stand
// where new ones do.
bool ChunkMap::rest_movers(std::uint32_t chunk, std::uint32_t& budget) {
  // Where so many begin to move that who rests will soon move again, filing costs more than it saves.
  constexpr std::size_t kSoon = 512;  // frames
  const bool open = chunk == open_ && chunks_[chunk].count < kCapacity;
  if (kSoon * woken_ < size_ && !file_rested(chunk, budget)) return false;
  chunks_[chunk].moved = {};
  if (open) return true;
  const bool due_here = is_page(chunks_[chunk]) && keeps_pages();
  if (chunks_[chunk].live <= kCapacity / 4 && !due_here) {
    for (std::uint32_t slot = 0; slot < chunks_[chunk].count && chunks_[chunk].live > 0; ++slot) {
      const ObjectId object = ids(chunks_[chunk])[slot];
      if (object == kNoObject) continue;
      const Box box = box_at(chunks_[chunk], slot);
      leave(chunk, slot);
      add_mover(object, box);
    }
  }
  flush();
  if (chunks_[chunk].live == 0) return true;  // it was freed
  const Box before = chunks_[chunk].bounds;
  const Box now = widened(tight(chunks_[chunk]));
  set_bounds(chunk, now);
  extend_group(chunks_[chunk].group, now);  // first, for shrinking asks nobody above to grow
  shrink_group(chunks_[chunk].group, before);
  return true;
}

}  // namespace sightline::world
