// What a view does with a group, told test by test. The tests are those of the passes.
#include "library/world/inspect_pass.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/world/inspect_pass.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/world/filtered_cull-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

inline std::uint64_t bits_in(std::uint64_t word) {
  return static_cast<std::uint64_t>(std::popcount(word));
}

inline std::uint64_t bits_in(const ObjectBits& bits) {
  return bits_in(bits.words[0]) + bits_in(bits.words[1]);
}

// One view and one group.
class GroupInspection {
public:
  GroupInspection(const PassInput& input, const Columns& columns, const GroupEntry& entry, std::size_t view,
                  ViewStats& stats)
      : input_(input),
        columns_(columns),
        at_(group_of(input, entry)),
        view_(at_.views[view]),
        planes_(entry.planes[view]),
        stats_(stats) {}

  ChunkSight run() {
    ChunkBits bits = classify_chunks(at_.group, view_, planes_);
    const std::uint32_t inside = bits.kept, crossing = bits.crossing;
    CrossedBits by_planes;
    Chunks chunks;
    find_chunks(at_, crossing, chunks);
    test_crossed(chunks, view_, planes_, bits, crossing, by_planes);
    parted_ = input_.columns ? ask_columns(input_, at_, view_, bits) : 0;
    const std::uint32_t left = bits.kept;
    ChunkAnswers visible;
    visible.fill(1);
    if (view_.occluders && left != 0) ask_chunks(at_.group, view_, visible);
    std::uint32_t seen = 0;
    for (std::uint32_t i = 0; i < at_.group.count; ++i) seen |= std::uint32_t{visible[i] != 0} << i;
    seen &= left;
    const std::uint32_t whole = seen & seen_whole(view_, bits, parted_);
    ++stats_.groups;
    stats_.chunks += at_.group.count;
    stats_.chunks_outside += at_.group.count - bits_in(inside);
    stats_.chunks_dropped += bits_in(inside & ~left), stats_.chunks_hidden += bits_in(left & ~seen);
    stats_.chunks_whole += bits_in(whole), stats_.chunks_opened += bits_in(seen & ~whole);
    for (std::uint32_t i = 0; i < at_.group.count; ++i) {
      const ChunkMap::ChunkView chunk = at_.map.chunk(at_.group, i);
      if ((seen & ~whole) >> i & 1) stats_.objects_tested += chunk.count;
      ObjectBits in_view;
      if (inside >> i & 1) in_view = crossing >> i & 1 ? by_planes[i] : first_objects(chunk.count);
      count_objects(chunk, in_view, seen >> i & 1);
    }
    return {seen, whole};
  }

private:
  void count_objects(const ChunkMap::ChunkView& chunk, const ObjectBits& in_view, bool chunk_seen) {
    ObjectBits left = live_objects(chunk);
    stats_.objects += bits_in(left);
    drop(left, in_view, stats_.outside);
    if (bits_in(left) == 0) return;
    if (columns_.has_layers)
      drop(left, kLayerTests.objects(at_.map, at_.group, chunk, view_), stats_.by_layers);
    if (columns_.has_distances)
      drop(left, kDistanceTests.objects(at_.map, at_.group, chunk, view_), stats_.by_distances);
    if (input_.columns)
      drop(left, input_.columns->objects(at_.map, at_.group, chunk, view_), stats_.by_casters);
    if (view_.area_scale > 0) drop(left, large_objects(chunk, view_), stats_.by_area);
    if (!chunk_seen) {
      drop(left, ObjectBits(), stats_.hidden);
    } else if (view_.occluders) {
      stats_.hidden += drop_hidden_objects(chunk, view_, left);
    }
    stats_.visible += bits_in(left);
  }

  // Takes out what is not among `kept`, and counts it.
  static void drop(ObjectBits& left, const ObjectBits& kept, std::uint64_t& count) {
    count += bits_in(left);
    left.keep(kept);
    count -= bits_in(left);
  }

  const PassInput& input_;
  const Columns& columns_;
  EntryGroup at_;
  const SectorView& view_;
  PlaneSet planes_;
  std::uint32_t parted_ = 0;
  ViewStats& stats_;
};

ChunkSight inspect_entry(const PassInput& input, const Columns& columns, const GroupEntry& entry,
                         std::size_t view, ViewStats& stats) {
  return GroupInspection(input, columns, entry, view, stats).run();
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {
HWY_EXPORT(inspect_entry);

ChunkSight inspect_group(const PassInput& input, const Columns& columns, const GroupEntry& entry,
                         std::size_t view, ViewStats& stats) noexcept {
  return HWY_DYNAMIC_DISPATCH(inspect_entry)(input, columns, entry, view, stats);
}

}  // namespace sightline::world
#endif
