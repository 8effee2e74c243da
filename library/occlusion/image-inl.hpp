// Vectors of points on the image and of the rectangles around them, for every SIMD width. Included by files
// that foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_IMAGE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_IMAGE_INL
#undef SIGHTLINE_OCCLUSION_IMAGE_INL
#else
#define SIGHTLINE_OCCLUSION_IMAGE_INL
#endif

#include <limits>

#include "library/geometry/error_bounds.hpp"
#include "library/geometry/simd-inl.hpp"
#include "library/occlusion/depth_tiles.hpp"

// What is called from two places is inlined in both, but not in WebAssembly, which a page's readers load.
#undef SIGHTLINE_INLINE_IN_BOTH
#if HWY_TARGET == HWY_WASM
#define SIGHTLINE_INLINE_IN_BOTH HWY_NOINLINE inline
#else
#define SIGHTLINE_INLINE_IN_BOTH HWY_INLINE
#endif

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

using namespace geometry;
using namespace geometry::HWY_NAMESPACE;
namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
using VF = hn::Vec<F>;
using I = hn::RebindToSigned<F>;
using VI = hn::Vec<I>;
using VPoints = Points<VF>;
using Corners = std::array<VPoints, 3>;  // of a vector of triangles, about the eye

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// As EyeProjection says.
HWY_INLINE VPoints about_eye(const EyeProjection& e, const VPoints& p) {
  const F f;
  const auto move = [&](VF at, float high, float low)
                        HWY_ATTR { return hn::Sub(hn::Sub(at, hn::Set(f, high)), hn::Set(f, low)); };
  return {move(p.x, e.eye_high.x, e.eye_low.x), move(p.y, e.eye_high.y, e.eye_low.y),
          move(p.z, e.eye_high.z, e.eye_low.z)};
}

HWY_INLINE VF reach_of(const Corners& corners) {
  return larger_of(larger_of(largest(corners[0]), largest(corners[1])), largest(corners[2]));
}

// Which side of the triangles' planes the eye is on: 1 in front, where corners turn counter-clockwise, -1
// behind; 0 where that is unsure.
HWY_INLINE VF side_of_planes(const DepthTiles& tiles, const Corners& corners) {
  const F f;
  const bool orthographic = tiles.projection.orthographic;
  const VPoints a = minus(corners[1], corners[0]), b = minus(corners[2], corners[0]), normal = cross(a, b);
  const VF along = orthographic ? dot(normal, tiles.rays.forward) : dot(normal, corners[0]);
  const VF reach = reach_of(corners), one_side = largest(a), other = largest(b);
  const VF least = orthographic ? hn::Set(f, tiles.rays.edge_on)
                                : hn::Add(hn::Mul(hn::Set(f, static_cast<float>(kEdgeOnPart)), reach),
                                          hn::Set(f, static_cast<float>(kEdgeOnDistance)));
  // The thinner or the farther away it is beside its size, the more its corners' rounding turns its plane.
  const VF twice = hn::Mul(hn::Add(one_side, one_side), other),
           turned =
               hn::Mul(hn::Set(f, kSideRounding), hn::Add(twice, hn::Mul(reach, hn::Add(one_side, other)))),
           rounding = orthographic ? turned : hn::Mul(turned, reach);
  const auto sure = hn::Gt(hn::Abs(along), hn::Add(hn::Mul(least, hn::Sqrt(dot(normal, normal))), rounding));
  const VF front = hn::Set(f, 1.0f);
  return hn::IfThenElseZero(sure, hn::IfThenElse(hn::Lt(along, hn::Zero(f)), front, hn::Neg(front)));
}

// Corners on the image. Equal corners of different triangles give equal bits.
struct OnImage {
  VF x[3], y[3], w[3], over_w[3];
};

HWY_INLINE OnImage on_image(const EyeProjection& e, const Corners& corners) {
  const F f;
  OnImage out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.w[k] = dot_row(e.w, corners[k]);
    out.over_w[k] = hn::Div(hn::Set(f, 1.0f), out.w[k]);
    out.x[k] = hn::Mul(dot_row(e.x, corners[k]), out.over_w[k]);
    out.y[k] = hn::Mul(dot_row(e.y, corners[k]), out.over_w[k]);
  }
  return out;
}

// Twice the triangles' areas on the image, by sign as they turn.
HWY_INLINE VF area_of(const OnImage& image) {
  const VF ax = image.x[0], ay = image.y[0];
  return hn::Sub(hn::Mul(hn::Sub(image.x[1], ax), hn::Sub(image.y[2], ay)),
                 hn::Mul(hn::Sub(image.x[2], ax), hn::Sub(image.y[1], ay)));
}

// A vector of rectangles of the image, in pixels.
struct Rectangles {
  VF left, right, top, bottom;
};

HWY_INLINE Rectangles no_rectangles() {
  const VF most = hn::Set(F(), kInfinity), least = hn::Neg(most);
  return {most, least, most, least};
}
HWY_INLINE void add_point(Rectangles& r, VF x, VF y) {
  r.left = hn::Min(r.left, x), r.right = hn::Max(r.right, x);
  r.top = hn::Min(r.top, y), r.bottom = hn::Max(r.bottom, y);
}
HWY_INLINE Rectangles grown(const Rectangles& r, VF by) {
  return {hn::Sub(r.left, by), hn::Add(r.right, by), hn::Sub(r.top, by), hn::Add(r.bottom, by)};
}
HWY_INLINE Rectangles shrunk(const Rectangles& r, VF by) {
  return {hn::Add(r.left, by), hn::Sub(r.right, by), hn::Add(r.top, by), hn::Sub(r.bottom, by)};
}
// The largest coordinate, whatever its sign.
HWY_INLINE VF widest_of(const Rectangles& r) {
  return hn::Max(hn::Max(hn::Abs(r.left), hn::Abs(r.right)), hn::Max(hn::Abs(r.top), hn::Abs(r.bottom)));
}
template <class Arrays>
HWY_INLINE void store(const Rectangles& r, Arrays& out, std::size_t lane) {
  const F f;
  hn::Store(r.left, f, &out.left[lane]);
  hn::Store(r.right, f, &out.right[lane]);
  hn::Store(r.top, f, &out.top[lane]);
  hn::Store(r.bottom, f, &out.bottom[lane]);
}

// First and last columns and rows whose pixel centres the rectangles hold, within the image; none where one
// of them does not lie in `some`.
struct PixelBounds {
  VF x0, x1, y0, y1;
  hn::Mask<F> some;
};

HWY_INLINE PixelBounds pixel_bounds(const DepthTiles& tiles, const Rectangles& r) {
  const F f;
  const VF half = hn::Set(f, 0.5f);
  const auto first = [&](VF low, std::uint32_t least) HWY_ATTR {
    return hn::Max(hn::Ceil(hn::Sub(low, half)), hn::Set(f, static_cast<float>(least)));
  };
  const auto last = [&](VF high, std::uint32_t end) HWY_ATTR {
    return hn::Min(hn::Floor(hn::Sub(high, half)), hn::Set(f, static_cast<float>(end) - 1));
  };
  const VF x0 = first(r.left, 0), x1 = last(r.right, tiles.width), y0 = first(r.top, tiles.first_row),
           y1 = last(r.bottom, tiles.end_row);
  return {x0, x1, y0, y1, hn::And(hn::Le(x0, x1), hn::Le(y0, y1))};
}

// The same in whole numbers, 0 but for the lanes of `asked`; and the tiles there.
struct PixelRanges {
  VI x0, x1, y0, y1;
  VI tx0, tx1, ty0, ty1;
  hn::Mask<I> many;  // hold tiles besides those of their corners
};

HWY_INLINE PixelRanges pixel_ranges(const PixelBounds& bounds, hn::Mask<F> asked) {
  const I i32;
  const auto whole = [&](VF at) HWY_ATTR { return hn::ConvertTo(i32, hn::IfThenElseZero(asked, at)); };
  PixelRanges out;
  out.x0 = whole(bounds.x0), out.x1 = whole(bounds.x1), out.y0 = whole(bounds.y0), out.y1 = whole(bounds.y1);
  out.tx0 = hn::ShiftRight<3>(out.x0), out.tx1 = hn::ShiftRight<3>(out.x1);
  out.ty0 = hn::ShiftRight<3>(out.y0), out.ty1 = hn::ShiftRight<3>(out.y1);
  const VI one = hn::Set(i32, 1);
  out.many = hn::Or(hn::Gt(hn::Sub(out.tx1, out.tx0), one), hn::Gt(hn::Sub(out.ty1, out.ty0), one));
  return out;
}

// The least value at the places where two columns cross two rows.
SIGHTLINE_INLINE_IN_BOTH VF least_where_crossed(const DepthTiles& tiles, const float* of, VI column0,
                                                VI column1, VI row0, VI row1) {
  const VI stride = hn::Set(I(), static_cast<std::int32_t>(tiles.stride));
  row0 = hn::Mul(row0, stride), row1 = hn::Mul(row1, stride);
  const auto at = [&](VI row, VI column) HWY_ATTR { return hn::GatherIndex(F(), of, hn::Add(row, column)); };
  return hn::Min(hn::Min(at(row0, column0), at(row0, column1)),
                 hn::Min(at(row1, column0), at(row1, column1)));
}

// The least value of the tiles at the corners, which are all tiles of a small rectangle.
HWY_INLINE VF least_at_corners(const DepthTiles& tiles, const float* of, const PixelRanges& r) {
  return least_where_crossed(tiles, of, r.tx0, r.tx1, r.ty0, r.ty1);
}

// Rounding of x, y and w, where it matters on which side of the image a point lies.
struct RowErrors {
  VF x, y, w;
};

// The most that rounding a row's product with any corner can lose.
HWY_INLINE VF error_of(const Vec4& row, const VF& reach) {
  const F f;
  const float size = std::fabs(row.x) + std::fabs(row.y) + std::fabs(row.z);
  return hn::Mul(hn::Set(f, kRowRounding),
                 hn::Add(hn::Mul(hn::Set(f, size), reach), hn::Set(f, std::fabs(row.w))));
}

// Of corners whose coordinates reach as far as `reach`.
HWY_INLINE RowErrors row_errors(const EyeProjection& e, VF reach) {
  return {error_of(e.x, reach), error_of(e.y, reach), error_of(e.w, reach)};
}

// Triangles that lie wholly to one side of what is in view, by more than so many pixels.
HWY_INLINE std::uint32_t beyond_a_side(const DepthTiles& tiles, const Corners& corners,
                                       const RowErrors& error, float by = 0) {
  const F f;
  const EyeProjection& e = tiles.projection;
  const VF width = hn::Set(f, static_cast<float>(tiles.width) + by),
           height = hn::Set(f, static_cast<float>(tiles.height) + by), more = hn::Set(f, by);
  auto left = hn::FirstN(f, hn::Lanes(f)), right = left, above = left, below = left;
  const VF left_error = hn::Add(error.x, hn::Mul(more, error.w)),
           above_error = hn::Add(error.y, hn::Mul(more, error.w)),
           right_error = hn::Add(error.x, hn::Mul(width, error.w)),
           below_error = hn::Add(error.y, hn::Mul(height, error.w));
  for (const VPoints& c : corners) {
    const VF x = dot_row(e.x, c), y = dot_row(e.y, c), w = dot_row(e.w, c);
    left = hn::And(left, hn::Lt(hn::Add(x, hn::Mul(more, w)), hn::Neg(left_error)));
    right = hn::And(right, hn::Gt(hn::Sub(x, hn::Mul(width, w)), right_error));
    above = hn::And(above, hn::Lt(hn::Add(y, hn::Mul(more, w)), hn::Neg(above_error)));
    below = hn::And(below, hn::Gt(hn::Sub(y, hn::Mul(height, w)), below_error));
  }
  return bits_of(f, hn::Or(hn::Or(left, right), hn::Or(above, below)));
}

alignas(64) constexpr float kColumn[64] = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5,
                                           6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3,
                                           4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
alignas(64) constexpr float kRow[64] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2,
                                        2, 2, 3, 3, 3, 3, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 5,
                                        5, 5, 5, 5, 6, 6, 6, 6, 6, 6, 6, 6, 7, 7, 7, 7, 7, 7, 7, 7};

// The 64 pixels of a tile that a plane covers.
HWY_INLINE void lay_plane(const TilePlane& plane, float* HWY_RESTRICT out) {
  const F f;
  const VF base = hn::Set(f, plane.base), across = hn::Set(f, plane.across), down = hn::Set(f, plane.down),
           step = hn::Set(f, 2 * plane.down);
  for (std::size_t i = 0; i < 16; i += hn::Lanes(f)) {
    VF depth = hn::Add(
        base, hn::Add(hn::Mul(across, hn::Load(f, kColumn + i)), hn::Mul(down, hn::Load(f, kRow + i))));
    for (std::size_t at = i; at < 64; at += 16) {
      hn::Store(depth, f, out + at);
      depth = hn::Add(depth, step);
    }
  }
}

// The 64 pixels of a tile that was drawn to; `room` for those that are nowhere yet.
HWY_INLINE const float* pixels_of_tile(const DepthTiles& tiles, std::size_t tile,
                                       std::array<float, 64>& room) {
  if (!(tiles.plane.base[tile] > -kInfinity)) return &tiles.nearness[tile * 64];
  lay_plane(tiles.plane.of(tile), room.data());
  return room.data();
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
