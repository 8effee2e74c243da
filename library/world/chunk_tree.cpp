// The k-d tree that the chunks of a key hang in: splitting full chunks, joining small ones.
#include <algorithm>
#include <optional>

#include "library/geometry/box_math.hpp"
#include "library/world/chunk_map.hpp"
#include "library/world/free_list.hpp"

namespace sightline::world {

using namespace geometry;

namespace {

// A plane: below it lie centres < at.
struct Cut {
  std::uint32_t axis;
  float at;
};

// The median along the longest axis, with some centres on either side; none where all are one point.
std::optional<Cut> median_cut(std::span<const Vec3> centres) {
  Box spread = kEmptyBox;
  for (const Vec3& p : centres) spread = united(spread, {p, p});
  std::uint32_t axis = 0;
  float longest = 0;
  for (std::uint32_t a = 0; a < 3; ++a) {
    const float length = coordinate(spread.max, a) - coordinate(spread.min, a);
    if (length > longest) longest = length, axis = a;
  }
  if (!(longest > 0)) return {};
  std::array<float, ChunkMap::kCapacity> room{};
  const std::span values = std::span(room).first(centres.size());
  for (std::size_t i = 0; i < centres.size(); ++i) values[i] = coordinate(centres[i], axis);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  float at = *middle;
  const float lowest = coordinate(spread.min, axis);
  if (at == lowest) {  // nothing would be below: take the next value up
    at = coordinate(spread.max, axis);
    for (const float value : values) {
      if (value > lowest) at = std::min(at, value);
    }
  }
  return Cut{axis, at};
}

}  // namespace

void ChunkMap::replace_reference(std::uint32_t key, std::uint32_t parent, std::uint32_t from,
                                 std::uint32_t to) noexcept {
  if (parent == kNone) {
    keys_[key].root = to;
  } else {
    auto& child = splits_[parent].child;
    child[child[1] == from] = to;
  }
}

// Halves a full chunk at the median of its centres along their longest axis. False where all are one point.
bool ChunkMap::split(std::uint32_t chunk) {
  const std::uint32_t count = chunks_[chunk].count;  // full: there are no holes
  std::array<Vec3, kCapacity> centres;
  for (std::uint32_t i = 0; i < count; ++i) centres[i] = centre_of(box_at(chunks_[chunk], i));
  const std::optional<Cut> cut = median_cut(std::span(centres).first(count));
  if (!cut) return false;

  const auto above =
      static_cast<std::uint32_t>(std::count_if(centres.begin(), centres.begin() + count, [&](const Vec3& p) {
        return coordinate(p, cut->axis) >= cut->at;
      }));
  const std::uint32_t added =
      add_chunk(chunks_[chunk].key, free_capacity(pools_[kStill], above + 1), chunks_[chunk].cell);
  Chunk &low = chunks_[chunk], &high = chunks_[added];
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const ObjectId object = ids(low)[i];
    const Box box = box_at(low, i);
    if (coordinate(centres[i], cut->axis) >= cut->at) {
      write(added, high.count++, object, box);
    } else {
      if (kept != i) write(chunk, kept, object, box);
      ++kept;
    }
  }
  low.count = low.live = kept;
  note_stale(chunk);
  high.live = high.count;
  coordinate(low.cell.max, cut->axis) = cut->at;
  coordinate(high.cell.min, cut->axis) = cut->at;

  const std::uint32_t node = take_element(splits_, free_splits_);
  splits_[node] = {cut->at, cut->axis, low.parent, {chunk | kChunkBit, added | kChunkBit}};
  replace_reference(low.key, low.parent, chunk | kChunkBit, node);
  low.parent = high.parent = node;

  const std::uint32_t group = low.group;
  add_objects(group, static_cast<std::int32_t>(kept) - static_cast<std::int32_t>(low.counted));
  low.counted = kept;
  low.wide = false;
  set_bounds(chunk, tight(low));
  note_change(chunk);
  put_in_group(added, group, tight(high));
  return true;
}

// A chunk with room for the centre: `chunk`, one of its halves, or a new head of its chain.
std::uint32_t ChunkMap::make_room(std::uint32_t chunk, const Vec3& centre) {
  if (chunks_[chunk].live < chunks_[chunk].capacity) return chunk;
  if (chunks_[chunk].capacity < kCapacity) {
    grow(chunk);
    return chunk;
  }
  if (chunks_[chunk].next == kNone && split(chunk)) {
    const Split& s = splits_[chunks_[chunk].parent];
    return s.child[coordinate(centre, s.axis) >= s.at] & ~kChunkBit;
  }
  // All centres in one point: no plane parts them.
  const std::uint32_t target = add_chunk(chunks_[chunk].key, kCapacity, chunks_[chunk].cell);
  Chunk &head = chunks_[target], &old = chunks_[chunk];
  head.parent = old.parent;
  head.next = chunk;
  old.previous = target;
  replace_reference(head.key, head.parent, chunk | kChunkBit, target | kChunkBit);
  return target;
}

// Takes an empty chunk out of its chain or tree, and frees it.
void ChunkMap::unlink(std::uint32_t chunk) {
  const Chunk c = chunks_[chunk];
  if (c.next != kNone) chunks_[c.next].previous = c.previous;
  if (c.previous != kNone) {
    chunks_[c.previous].next = c.next;
  } else if (c.next != kNone) {
    replace_reference(c.key, c.parent, chunk | kChunkBit, c.next | kChunkBit);
    chunks_[c.next].parent = c.parent;
  } else if (c.parent == kNone) {
    keys_[c.key].root = kNone;
  } else {
    // The sibling takes the place of the split. Its chunks' cells stay as they are: too small is only slower.
    const Split split = splits_[c.parent];
    const std::uint32_t sibling = split.child[split.child[0] == (chunk | kChunkBit)];
    replace_reference(c.key, split.parent, c.parent, sibling);
    if (is_chunk(sibling)) {
      chunks_[sibling & ~kChunkBit].parent = split.parent;
    } else {
      splits_[sibling].parent = split.parent;
    }
    free_splits_.push_back(c.parent);
  }
  free_chunk(chunk);
}

// Joins a chunk that has become small with its sibling, where both together stay half empty.
void ChunkMap::try_merge(std::uint32_t chunk) {
  const Chunk& c = chunks_[chunk];
  if (c.parent == kNone || c.next != kNone || c.previous != kNone || c.live > kCapacity / 4) return;
  const Split& split = splits_[c.parent];
  const std::uint32_t side = split.child[0] == (chunk | kChunkBit);
  if (!is_chunk(split.child[side])) return;
  const std::uint32_t sibling = split.child[side] & ~kChunkBit;
  Chunk& s = chunks_[sibling];
  const std::uint32_t joined = s.live + c.live;
  if (s.next != kNone || joined > kCapacity / 2) return;
  if (joined > s.capacity && s.capacity == kSmallCapacity) return;
  if (joined > s.capacity) grow(sibling);
  const Box moved = c.bounds;
  for (std::uint32_t i = 0; i < c.count; ++i) {
    if (ids(c)[i] != kNoObject) write(sibling, take_slot(s), ids(c)[i], box_at(c, i));
  }
  add_objects(c.group, -static_cast<std::int32_t>(c.counted));
  add_objects(s.group, static_cast<std::int32_t>(s.live) - static_cast<std::int32_t>(s.counted));
  s.counted = s.live;
  extend(sibling, moved);
  coordinate(s.cell.min, split.axis) =
      std::min(coordinate(s.cell.min, split.axis), coordinate(c.cell.min, split.axis));
  coordinate(s.cell.max, split.axis) =
      std::max(coordinate(s.cell.max, split.axis), coordinate(c.cell.max, split.axis));
  note_change(sibling);
  chunks_[chunk].count = chunks_[chunk].live = chunks_[chunk].counted = 0;
  unlink(chunk);
}

}  // namespace sightline::world
