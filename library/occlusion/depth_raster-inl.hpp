// Convex polygons into the tiles of an occlusion buffer, for every SIMD width. Included by files that
// foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_DEPTH_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_DEPTH_RASTER_INL
#undef SIGHTLINE_OCCLUSION_DEPTH_RASTER_INL
#else
#define SIGHTLINE_OCCLUSION_DEPTH_RASTER_INL
#endif

#include "library/geometry/mutant.h"
#include "library/occlusion/tile_steps-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// The pixels of a step's tiles, of the spans of two rows.
SIGHTLINE_INLINE_IN_BOTH Held store_step_pixels(const Spans& spans, const Step& step, std::uint64_t* out) {
  const Held first = store_pixels(spans, 0, step.tx * kTile, step.columns, out),
             second = store_pixels(spans, kTile, step.tx * kTile, step.columns, out + kStepColumns);
  return {first.some | second.some << kStepColumns, first.all | second.all << kStepColumns};
}

// The same where all of them are set.
HWY_INLINE Held store_whole_step(const Step& step, std::uint64_t* out) {
  const Words words;
  for (std::size_t tile = 0; tile < kStepTiles; tile += kWords)
    hn::StoreU(hn::Set(words, ~std::uint64_t{0}), words, out + tile);
  return {step.asked(), step.asked()};
}

// What of a polygon's pixels is left out: nothing.
struct NothingLeftOut {
  // The sixteen lines from a pixel centre on come next.
  void come_to(float) {}
  // Of the columns that these lines hold whole, leaves some of which nothing is left out.
  void narrow_whole(TileColumns&) const {}
  void take_from(const Step&, std::uint64_t*, Held&) const {}
};

// The pixels of some bands, but those of the polygon's middle; or, where that is drawn already, those of its
// middle, too.
class BandsLeftOut {
public:
  BandsLeftOut(const DepthTiles& tiles, const Bands& bands, const Convex& middle, bool with_middle)
      : bands_(bands), middle_(middle), with_middle_(with_middle), width_(static_cast<float>(tiles.width)) {}
  void come_to(float first_y) {
    count_ = 0;
    for (std::size_t i = 0; i < bands_.count; ++i) {
      if (bands_.top[i] > first_y + 15 || bands_.bottom[i] < first_y) continue;
      spans_[count_] = spans_of(bands_, i, first_y, width_);
      columns_[count_] = columns_of(spans_[count_]);
      count_ += columns_[count_].begin < columns_[count_].end;
    }
    if (count_ > 0 || with_middle_) middle_spans_ = spans_of(middle_, first_y, width_);
  }
  void narrow_whole(TileColumns& columns) const {
    if (with_middle_) columns.end_whole = columns.begin_whole;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::uint32_t begin = std::max(columns_[i].begin, columns.begin_whole),
                          end = std::min(columns_[i].end, columns.end_whole);
      if (begin >= end) continue;
      if (begin - columns.begin_whole > columns.end_whole - end)
        columns.end_whole = begin;
      else
        columns.begin_whole = end;
    }
  }
  HWY_INLINE void take_from(const Step& step, std::uint64_t* pixels, Held& held) const {
    const Words words;
    alignas(64) std::array<std::uint64_t, kStepTiles> its, of_bands{};
    bool some = with_middle_;
    for (std::size_t i = 0; i < count_; ++i) {
      if (columns_[i].begin >= step.tx + step.columns || columns_[i].end <= step.tx) continue;
      some = true;
      store_step_pixels(spans_[i], step, its.data());
      for_words(step, [&](std::size_t tile) HWY_ATTR {
        const auto both = hn::Or(hn::LoadU(words, &its[tile]), hn::LoadU(words, &of_bands[tile]));
        hn::StoreU(both, words, &of_bands[tile]);
      });
    }
    if (!some) return;
    store_step_pixels(middle_spans_, step, its.data());
    held = {};
    for_words(step, [&](std::size_t tile) HWY_ATTR {
      const auto middle = hn::LoadU(words, &its[tile]), bands = hn::LoadU(words, &of_bands[tile]),
                 out = with_middle_ ? hn::Or(middle, bands) : hn::AndNot(middle, bands);
      const auto rest = hn::AndNot(out, hn::LoadU(words, pixels + tile));
      hn::StoreU(rest, words, pixels + tile);
      add_held(rest, tile, held);
    });
  }

private:
  // word(tile) for each vector of a step's tiles.
  template <class Word>
  static HWY_INLINE void for_words(const Step& step, const Word& word) {
    for (std::size_t row = 0; row < kStepTiles; row += kStepColumns) {
      for (std::size_t tile = row; tile < row + step.columns; tile += kWords) word(tile);
    }
  }

  const Bands& bands_;
  const Convex& middle_;
  bool with_middle_;
  float width_;
  // Of these lines: the spans of the bands that reach into them, their columns, and the middle's spans.
  std::array<Spans, Bands::kMost> spans_;
  std::array<TileColumns, Bands::kMost> columns_;
  Spans middle_spans_;
  std::size_t count_ = 0;
};

// The columns of two rows of tiles, of those in range. Of a wide polygon that lies aslant they hold only a
// part, and most of that whole.
template <class LeftOut>
HWY_INLINE TileColumns columns_in(const TileRange& range, const Spans& spans, const LeftOut& left_out) {
  if (range.end_x - range.begin_x <= kStepColumns) return {range.begin_x, range.end_x};
  TileColumns out = columns_of(spans);
  out.begin = std::max(out.begin, range.begin_x), out.end = std::min(out.end, range.end_x);
  out.begin_whole = std::max(out.begin_whole, out.begin), out.end_whole = std::min(out.end_whole, out.end);
  left_out.narrow_whole(out);
  // A step that is cut short costs as much as one that is not.
  if (out.end_whole < out.begin_whole + kStepColumns) out.begin_whole = out.end_whole = out.end;
  return out;
}

// Lists what `spans_from` says of sixteen lines from a pixel centre on, but what is left out.
template <std::size_t kPlanes, class SpansFrom, class LeftOut>
HWY_INLINE void list_spans(DepthTiles& tiles, const Planes<kPlanes>& planes, const TileRange& range,
                           const SpansFrom& spans_from, LeftOut& left_out, TileList<kPlanes>& list) {
  if (list.shape_count == list.kMostShapes) draw_listed(tiles, list);
  list.shapes[list.shape_count++] = tile_of(planes);
  for (std::uint32_t ty = range.begin_y; ty < range.end_y; ty += kStepRows) {
    const float first_y = static_cast<float>(ty * kTile) + 0.5f;
    const Spans spans = spans_from(first_y);
    left_out.come_to(first_y);
    const TileColumns columns = columns_in(range, spans, left_out);
    const std::uint32_t rows = std::min(kStepRows, range.end_y - ty);
    for (std::uint32_t tx = columns.begin, next = 0; tx < columns.end; tx = next) {
      const bool whole = columns.begin_whole <= tx && tx < columns.end_whole;
      const std::uint32_t end = tx < columns.begin_whole ? columns.begin_whole
                                : whole                  ? columns.end_whole
                                                         : columns.end;
      const Step step{tx, ty, std::min(kStepColumns, end - tx), rows};
      next = tx + step.columns;
      make_room(tiles, list);
      std::uint64_t* pixels = &list.pixels[list.size];
      Held held = whole ? store_whole_step(step, pixels) : store_step_pixels(spans, step, pixels);
      left_out.take_from(step, pixels, held);
      take_step(tiles, step, held, list);
    }
  }
}

template <std::size_t kPlanes, class SpansFrom>
HWY_INLINE void list_spans(DepthTiles& tiles, const Planes<kPlanes>& planes, const TileRange& range,
                           const SpansFrom& spans_from, TileList<kPlanes>& list) {
  NothingLeftOut nothing;
  list_spans(tiles, planes, range, spans_from, nothing, list);
}

constexpr Convex kNoPixels = [] {
  Convex out{};
  out.top = 1;
  return out;
}();

template <class LeftOut>
HWY_INLINE void list_polygon_but(DepthTiles& tiles, const Convex& polygon, const TileRange& range,
                                 LeftOut& left_out, TileList<1>& list) {
  list_spans(
      tiles, Planes<1>{{polygon.at}, {polygon.across}, {polygon.down}}, range,
      [&](float first_y) HWY_ATTR { return spans_of(polygon, first_y, static_cast<float>(tiles.width)); },
      left_out, list);
}

// Lists a polygon, but for the pixels of some bands that are none of `middle`, the part of it that it covers
// alone; without those of the middle, too, where that is drawn already.
HWY_NOINLINE inline void list_polygon(DepthTiles& tiles, const Convex& polygon, const TileRange& range,
                                      const Bands& without, const Convex& middle, bool without_middle,
                                      TileList<1>& list) {
  if (!polygon.has_left || !polygon.has_right) return;
  BandsLeftOut left_out(tiles, without, middle.has_left && middle.has_right ? middle : kNoPixels,
                        without_middle);
  list_polygon_but(tiles, polygon, range, left_out, list);
}

// Lists all of it: where only pixel centres count nothing is left out, and room for bands would take its
// time in every step.
HWY_NOINLINE inline void list_polygon(DepthTiles& tiles, const Convex& polygon, const TileRange& range,
                                      TileList<1>& list) {
  if (!polygon.has_left || !polygon.has_right) return;
  NothingLeftOut nothing;
  list_polygon_but(tiles, polygon, range, nothing, list);
}

// How far a polygon is moved away for its neighbours' sake, where a pixel's margin counts: what it shares
// with them lies as deep as the steepest of them falls within a margin.
HWY_INLINE float deeper_by(const DepthTiles& tiles, const Convex& polygon, float slant) {
  return tiles.around() * std::max(0.0f, slant - (std::fabs(polygon.across) + std::fabs(polygon.down)));
}

// Whether that is so far, where the polygon is farthest in the image, that its middle is drawn on its own
// plane.
HWY_INLINE bool is_much_deeper(const DepthTiles& tiles, const Convex& polygon, float deeper) {
  constexpr float kLeastDeeper = 1e-2f;  // of the nearness
  const auto width = static_cast<float>(tiles.width), height = static_cast<float>(tiles.height);
  const float x = polygon.across > 0 ? std::max(polygon.left, 0.0f) : std::min(polygon.right, width),
              y = polygon.down > 0 ? std::max(polygon.top, 0.0f) : std::min(polygon.bottom, height);
  return deeper > kLeastDeeper * std::fabs(polygon.at + x * polygon.across + y * polygon.down);
}

// Whether all of the tiles lie nearer than `nearness`; false where one would need a closer look.
SIGHTLINE_INLINE_IN_BOTH bool hidden_tiles(const DepthTiles& tiles, const TileRange& range, float nearness) {
  const F f;
  const VF limit = hn::Set(f, nearness);
  for (std::uint32_t ty = range.begin_y; ty < range.end_y; ++ty) {
    const float* row = &tiles.farthest[std::size_t{ty} * tiles.stride];
    for (std::uint32_t tx = range.begin_x; tx < range.end_x; tx += static_cast<std::uint32_t>(hn::Lanes(f))) {
      const auto open = hn::Lt(hn::LoadU(f, row + tx), limit);
      if (!hn::AllFalse(f, hn::And(open, hn::FirstN(f, range.end_x - tx)))) return false;
    }
  }
  return true;
}

// Planes moved away by what rounding can have brought them nearer: of the numbers, and of the pixel's place
// on a surface seen edge on; and to where they are farthest as far from a pixel's centre as it counts.
HWY_INLINE VF moved_back(const DepthTiles& tiles, VF at, VF across, VF down, VF nearest) {
  const F f;
  const VF slant = hn::Mul(hn::Add(hn::Abs(across), hn::Abs(down)), hn::Set(f, kPixelPlay + tiles.around()));
  if (SIGHTLINE_MUTANT(occluders_a_step_too_near))
    return hn::Add(at, hn::Mul(hn::Set(f, kNearnessRounding), hn::Abs(nearest)));
  return hn::Sub(at, hn::Add(hn::Mul(hn::Set(f, kNearnessRounding), hn::Abs(nearest)), slant));
}

// How far inside its outline an occluder must hold a pixel centre whose outline reaches `widest` pixels far.
HWY_INLINE VF inset_of(const DepthTiles& tiles, VF widest) {
  const F f;
  if (SIGHTLINE_MUTANT(outlines_not_inset)) return hn::Zero(f);
  return hn::Add(hn::Set(f, kInset + tiles.around()), hn::Mul(hn::Set(f, kInsetGrowth), widest));
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
