// Culling into ranges of an order: of a chunk that lies wholly in view nothing is read but how many it holds.
#include "library/world/range_cull.hpp"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/world/range_cull.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/world/filtered_cull-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

// Writes ranges, joining those that follow one another.
class RangeWriter {
public:
  RangeWriter(SlotRange* HWY_RESTRICT out, std::uint8_t* HWY_RESTRICT masks) : out_(out), masks_(masks) {}

  HWY_INLINE void add(std::uint32_t first, std::uint32_t count, std::uint8_t mask) {
    objects_ += count;
    if (joins(first, mask)) {
      last().count += count;
      return;
    }
    if (masks_) masks_[written_] = mask;
    out_[written_++] = {first, count};
  }

  // Of the slots from `first` on those whose bits are set. How many runs there are is the one thing to guess.
  HWY_INLINE void add_bits(std::uint32_t first, std::uint64_t bits, std::uint8_t mask) {
    objects_ += static_cast<std::uint64_t>(std::popcount(bits));
    if ((bits & 1) && joins(first, mask)) {
      last().count += static_cast<std::uint32_t>(std::countr_one(bits));
      bits &= bits + 1;
    }
    std::uint64_t starts = bits & ~(bits << 1), ends = bits & ~(bits >> 1);
    std::size_t to = written_;
    for (; starts != 0; starts &= starts - 1, ends &= ends - 1, ++to) {
      const auto at = static_cast<std::uint32_t>(std::countr_zero(starts));
      out_[to] = {first + at, static_cast<std::uint32_t>(std::countr_zero(ends)) - at + 1};
    }
    if (masks_) std::fill(masks_ + written_, masks_ + to, mask);
    written_ = to;
  }

  // The chunks whose bits are set, all objects of each.
  HWY_INLINE void add_chunks(const EntryGroup& at, const std::uint32_t* slots, std::uint32_t bits,
                             std::uint8_t mask) {
    SlotRange run;  // in registers, while one chunk follows the other
    for (; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
      const std::uint32_t first = slots[at.group.chunks[i]], size = at.group.count_and_size[i];
      if (size & ChunkMap::Group::kLoose) {
        add_run(run, mask), run = {};
        add_loose(at.map.chunk(at.group, i), first, mask);
      } else if (first == run.first + run.count) {
        run.count += size & ChunkMap::Group::kCount;
      } else {
        add_run(run, mask);
        run = {first, size & ChunkMap::Group::kCount};
      }
    }
    add_run(run, mask);
  }

  HWY_INLINE void add_loose(const ChunkMap::ChunkView& chunk, std::uint32_t first, std::uint8_t mask);

  [[nodiscard]] std::size_t written() const { return written_; }
  [[nodiscard]] std::uint64_t objects() const { return objects_; }

private:
  HWY_INLINE SlotRange& last() { return out_[written_ - 1]; }
  HWY_INLINE bool joins(std::uint32_t first, std::uint8_t mask) {
    return written_ > 0 && last().first + last().count == first && (!masks_ || masks_[written_ - 1] == mask);
  }
  HWY_INLINE void add_run(const SlotRange& run, std::uint8_t mask) {
    if (run.count > 0) add(run.first, run.count, mask);
  }

  SlotRange* HWY_RESTRICT out_;
  std::uint8_t* HWY_RESTRICT masks_;
  std::size_t written_ = 0;
  std::uint64_t objects_ = 0;
};

// All of a chunk with holes.
HWY_INLINE void RangeWriter::add_loose(const ChunkMap::ChunkView& chunk, std::uint32_t first,
                                       std::uint8_t mask) {
  const ObjectBits live = live_objects(chunk);
  for (std::uint32_t w = 0; w < 2; ++w) add_bits(first + 64 * w, live.words[w], mask);
}

HWY_INLINE void write_whole_range(const ChunkMap::ChunkView& chunk, std::uint32_t first, std::uint8_t mask,
                                  RangeWriter& out) {
  chunk.loose ? out.add_loose(chunk, first, mask) : out.add(first, chunk.count, mask);
}

// The runs of a chunk's objects that the same views see; those of `whole` see all.
HWY_INLINE void write_masked_ranges(const ChunkMap::ChunkView& chunk, std::uint32_t first, std::uint8_t whole,
                                    const ChunkViews& parts, RangeWriter& out) {
  const ObjectBits live = whole != 0 ? live_objects(chunk) : ObjectBits();
  for (std::uint32_t w = 0; w < 2; ++w) {
    std::uint64_t some = live.words[w];
    for (std::size_t k = 0; k < parts.count; ++k) some |= parts.seen[k].words[w];
    while (some != 0) {
      const int at = std::countr_zero(some);
      std::uint64_t run = some;
      std::uint8_t mask = whole;
      for (std::size_t k = 0; k < parts.count; ++k) {
        const std::uint64_t seen = parts.seen[k].words[w];
        const bool sees = seen >> at & 1;
        run &= sees ? seen : ~seen;
        if (sees) mask |= parts.bits[k];
      }
      const int count = std::countr_one(run >> at);
      out.add(first + 64 * w + static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(count), mask);
      some = at + count < 64 ? some >> (at + count) << (at + count) : 0;
    }
  }
}

HWY_INLINE void write_seen_ranges(const ChunkMap::ChunkView& chunk, std::uint32_t first, std::uint8_t whole,
                                  const ChunkViews& parts, bool masks, RangeWriter& out) {
  if (masks && (whole != 0 || parts.count > 1)) return write_masked_ranges(chunk, first, whole, parts, out);
  for (std::uint32_t w = 0; w < 2; ++w) {
    std::uint64_t some = 0;
    for (std::size_t k = 0; k < parts.count; ++k) some |= parts.seen[k].words[w];
    out.add_bits(first + 64 * w, some, parts.bits[0]);
  }
}

HWY_INLINE std::uint8_t bits_of_viewers(const PassInput& input, const ChunkViewers& viewers) {
  std::uint8_t bits = viewers.whole;
  for (std::uint32_t rest = viewers.part; rest != 0; rest &= rest - 1)
    bits |= input.bits[std::countr_zero(rest)];
  return bits;
}

// What the views see of a group's chunks, before any object is looked at.
struct GroupSight {
  std::array<ChunkBits, kMaxViews> bits;
  std::array<std::uint32_t, kMaxViews> parted;
  std::uint32_t any = 0;
};

class RangePass {
public:
  RangePass(const RangeInput& input, SlotRange* out, std::uint8_t* masks)
      : input_(input), pass_(input.pass), out_(out, masks), masks_(masks != nullptr) {}

  HWY_INLINE void cull(const GroupEntry& entry) {
    const EntryGroup at = group_of(pass_, entry);
    const std::uint32_t* slots = input_.first_slots[entry.sector];
    look(entry, at);
    counts_.chunks += at.group.count;
    if (!input_.whole_chunks) test_crossed_by(entry, at);
    std::uint32_t rest = sight_.any;
    if (pass_.view_count == 1) {
      // Those that nothing is to be asked of, at once.
      const std::uint32_t part =
          input_.whole_chunks ? 0 : rest & ~seen_whole(*at.views, sight_.bits[0], sight_.parted[0]);
      out_.add_chunks(at, slots, rest & ~part, pass_.bits[0]);
      rest &= part;
    }
    for (; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      const ChunkMap::ChunkView chunk = at.map.chunk(at.group, i);
      const std::uint32_t first = slots[at.group.chunks[i]];
      const ChunkViewers viewers = viewers_of(pass_, at, sight_.bits, sight_.parted, i);
      if (input_.whole_chunks) {
        write_whole_range(chunk, first, bits_of_viewers(pass_, viewers), out_);
      } else if (viewers.part == 0 || (viewers.whole != 0 && !masks_)) {
        write_whole_range(chunk, first, viewers.whole, out_);
      } else {
        test(at, i, chunk, viewers.part);
        write_seen_ranges(chunk, first, viewers.whole, parts_, masks_, out_);
      }
    }
  }

  HWY_INLINE RangeCounts end() {
    counts_.written = out_.written();
    counts_.objects = out_.objects();
    return counts_;
  }

private:
  void count_occluded(std::size_t v, std::uint64_t objects) {
    counts_.occluded += static_cast<std::uint64_t>(std::popcount(pass_.bits[v])) * objects;
  }

  HWY_INLINE void look(const GroupEntry& entry, const EntryGroup& at) {
    sight_.any = 0;
    for (std::size_t v = 0; v < pass_.view_count; ++v) {
      std::uint64_t dropped = 0;
      sight_.bits[v] =
          filter_chunks(pass_, at, at.views[v], entry.planes[v], nullptr, sight_.parted[v], dropped);
      count_occluded(v, dropped);
      sight_.any |= sight_.bits[v].kept;
    }
  }

  // What is written whole needs nothing of memory but movers' ids. By itself, as it may be left out.
  HWY_NOINLINE void test_crossed_by(const GroupEntry& entry, const EntryGroup& at) {
    std::uint32_t crossed = 0;
    for (std::size_t v = 0; v < pass_.view_count; ++v) crossed |= sight_.bits[v].crossing | sight_.parted[v];
    Chunks chunks;
    for (std::uint32_t rest = crossed & sight_.any; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      chunks[i] = at.map.chunk(at.group, i);
      hwy::Prefetch(chunks[i].sides);
    }
    test_crossed_by_all(pass_, entry, at.views, sight_.bits, sight_.parted, masks_, chunks, left_);
  }

  HWY_INLINE void test(const EntryGroup& at, std::uint32_t i, const ChunkMap::ChunkView& chunk,
                       std::uint8_t by) {
    parts_.count = 0;
    for (std::uint32_t rest = by; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<std::size_t>(std::countr_zero(rest));
      const ObjectBits* by_planes = sight_.bits[v].crossing >> i & 1 ? &left_[v][i] : nullptr;
      std::uint64_t occluded = 0;
      parts_.bits[parts_.count] = pass_.bits[v];
      parts_.seen[parts_.count++] =
          view_objects(pass_, at, at.views[v], chunk, by_planes, sight_.parted[v] >> i & 1, occluded);
      counts_.tested += chunk.count;
      count_occluded(v, occluded);
    }
  }

  const RangeInput& input_;
  const PassInput& pass_;
  RangeWriter out_;
  bool masks_;
  GroupSight sight_;
  std::array<CrossedBits, kMaxViews> left_;
  ChunkViews parts_;
  RangeCounts counts_;
};

RangeCounts visible_ranges(const RangeInput& input, std::span<const GroupEntry> entries, SlotRange* out,
                           std::uint8_t* masks) {
  RangePass pass(input, out, masks);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (e + 2 < entries.size()) prefetch_lines(group_of(input.pass, entries[e + 2]).group);
    pass.cull(entries[e]);
  }
  return pass.end();
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {
HWY_EXPORT(visible_ranges);

RangeCounts cull_ranges(const RangeInput& input, std::span<const GroupEntry> entries, SlotRange* out,
                        std::uint8_t* masks) noexcept {
  return HWY_DYNAMIC_DISPATCH(visible_ranges)(input, entries, out, masks);
}

}  // namespace sightline::world
#endif
