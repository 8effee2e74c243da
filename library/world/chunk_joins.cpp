// Many objects that begin to move at once. They join the movers block by block; what they leave lies far
// apart in memory, and waits until all of it can be dealt with in the order in which it stands.
#include <algorithm>
#include <utility>

#include "library/geometry/ask_ahead.hpp"
#include "library/geometry/box_math.hpp"
#include "library/world/chunk_map.hpp"
#include "library/world/chunk_runs.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

constexpr std::uint32_t kWord = 32;  // bits

void set_bit(std::vector<std::uint32_t>& bits, ObjectId object) {
  bits[object / kWord] |= 1u << object % kWord;
}

}  // namespace

// Notes that an object is about to leave the chunk where it stands, which is no page.
void ChunkMap::leave_soon(ObjectId object) {
  // Looking through all chunks costs as much as visiting those of so many.
  constexpr std::size_t kShareOfAll = 32;
  const Location& at = (*locations_)[object];
  auto& bits = leaving_bits_[at.moves() ? kMovers : kStill];
  if (!bits.empty()) return set_bit(bits, object);
  leaving_.push_back({object, at.chunk, at.slot_and_history & 0xff});
  if (leaving_.size() < size_ / kShareOfAll) return;
  for (const Leaving& one : leaving_) {
    auto& its = leaving_bits_[one.slot & Location::kMoves ? kMovers : kStill];
    if (its.empty()) its.resize(locations_->size() / kWord + 1);
    set_bit(its, one.object);
  }
  leaving_.clear();
}

void ChunkMap::leave_now() {
  if (!kHasPages) return;
  for (const std::uint8_t pool : {kStill, kMovers})
    if (!leaving_bits_[pool].empty()) leave_all(pool);
  // What it takes is asked for in two steps, each when the one before has arrived: memory answers few at a
  // time, so that asking for many at once gains little.
  constexpr std::size_t kId = 16, kChunk = 32;
  const auto slot_of = [](const Leaving& one) { return one.slot & (Location::kMoves - 1); };
  for (std::size_t i = 0; i < leaving_.size(); ++i) {
    if (i + kChunk < leaving_.size()) ask_ahead(&chunks_[leaving_[i + kChunk].chunk]);
    if (i + kId < leaving_.size()) {
      const Leaving& next = leaving_[i + kId];
      ask_ahead(ids(chunks_[next.chunk]) + slot_of(next));
    }
    leave(leaving_[i].chunk, slot_of(leaving_[i]));
  }
  leaving_.clear();
}

// Those whose bits are set, chunk by chunk.
void ChunkMap::leave_all(std::uint8_t pool) {
  constexpr std::uint32_t kAhead = 16, kLine = 16;
  const auto bits = std::exchange(leaving_bits_[pool], {});
  for (std::uint32_t chunk = 0; chunk < chunks_.size(); ++chunk) {
    if (chunk + kAhead < chunks_.size()) {
      const Chunk& next = chunks_[chunk + kAhead];
      for (std::uint32_t slot = 0; slot < next.count; slot += kLine) ask_ahead(ids(next) + slot);
    }
    Chunk& c = chunks_[chunk];
    if (c.pool != pool || c.live == 0 || (pool == kMovers && is_page(c))) continue;
    const std::uint32_t left = take_out(ids(c), c.count, bits);
    if (left == 0) continue;
    c.live -= left, ++changes_[pool];
    make_dirty(chunk);
    if (has_columns()) note_stale(chunk);
    if (pool == kMovers) continue;
    c.moved[0] = 1;
    note_grown(chunk);
  }
}

std::uint32_t ChunkMap::join_movers(const ObjectId* objects, std::uint32_t sector, const BoxBlock& boxes,
                                    std::size_t first, std::uint32_t count) {
  const auto stands_still = [&](ObjectId object) {
    const Location& at = (*locations_)[object];
    return at.sector == sector && !at.moves();
  };
  if (!keeps_movers() || !stands_still(objects[0])) return 0;
  loosely_ = true;
  const std::uint32_t chunk = open_mover_chunk();
  Chunk& c = chunks_[chunk];
  const std::uint32_t begin = c.count, most = std::min(count, kCapacity - begin);
  std::uint32_t joined = 0;
  for (; joined < most && stands_still(objects[joined]); ++joined) {
    const std::uint32_t slot = begin + joined;
    leave_soon(objects[joined]);
    Location& at = (*locations_)[objects[joined]];
    at.chunk = chunk, at.slot_and_history = (at.slot_and_history & ~0xffu) | Location::kMoves | slot;
    c.moved[slot / 64] |= std::uint64_t{1} << slot % 64;
  }
  const auto copy = [&](const auto* from, auto* to) {
    constexpr std::uint32_t kWorthACall = 8;
    if (joined >= kWorthACall) return void(std::copy_n(from, joined, to));
    for (std::uint32_t i = 0; i < joined; ++i) to[i] = from[i];
  };
  copy(objects, ids(c) + begin);
  for (std::uint32_t side = 0; side < 6; ++side) copy(&boxes.values[side][first], lanes(c, side) + begin);
  c.count += joined, c.live += joined;
  const Box now = bounds_of_rows(&boxes.values[0][first], kBlock, joined);
  if (!holds(c.bounds, now)) c.bounds = widened(united(c.bounds, now));
  if (has_columns()) load_columns(c), note_stale(chunk);
  make_dirty(chunk);
  ++changes_[kMovers], joined_ += joined, woken_ += joined;
  return joined;
}

}  // namespace sightline::world
