// Boxes against the tiles.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "library/occlusion/depth_tiles.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/occlusion/box_queries.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/occlusion/depth_query-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// Boxes a vector at a time: rectangles and nearest depths; then each against the tiles.
void query_all_boxes(const DepthTiles& tiles, const EyeProjection& e, const BoxSpan& boxes,
                     std::uint8_t* visible) {
  const F f;
  const std::size_t lanes = hn::Lanes(f);
  for (std::size_t first = 0; first < boxes.count; first += lanes) {
    // The last vector repeats boxes rather than reading beyond them.
    alignas(64) std::array<std::array<float, 16>, 6> tail;
    const std::size_t count = std::min(lanes, boxes.count - first);
    const float* from[6] = {boxes.min_x + first, boxes.min_y + first, boxes.min_z + first,
                            boxes.max_x + first, boxes.max_y + first, boxes.max_z + first};
    if (count < lanes) {
      for (std::size_t side = 0; side < 6; ++side) {
        for (std::size_t i = 0; i < lanes; ++i) tail[side][i] = from[side][std::min(i, count - 1)];
        from[side] = tail[side].data();
      }
    }
    const auto about_eye = [&](std::size_t side, float high, float low) HWY_ATTR {
      return hn::Sub(hn::Sub(hn::LoadU(f, from[side]), hn::Set(f, high)), hn::Set(f, low));
    };
    const VF q[2][3] = {{about_eye(0, e.eye_high.x, e.eye_low.x), about_eye(1, e.eye_high.y, e.eye_low.y),
                         about_eye(2, e.eye_high.z, e.eye_low.z)},
                        {about_eye(3, e.eye_high.x, e.eye_low.x), about_eye(4, e.eye_high.y, e.eye_low.y),
                         about_eye(5, e.eye_high.z, e.eye_low.z)}};
    const VF reach_x = hn::Max(hn::Abs(q[0][0]), hn::Abs(q[1][0])),
             reach_y = hn::Max(hn::Abs(q[0][1]), hn::Abs(q[1][1])),
             reach_z = hn::Max(hn::Abs(q[0][2]), hn::Abs(q[1][2]));
    // The products of a row, and what rounding them, their sum and the row itself can lose.
    struct Terms {
      VF x[2], y[2], z[2], error;
    };
    constexpr float kRounding = 8 * std::numeric_limits<float>::epsilon();
    const auto terms = [&](const Vec4& row) HWY_ATTR {
      Terms t;
      for (int s = 0; s < 2; ++s) {
        t.x[s] = hn::Add(hn::Mul(hn::Set(f, row.x), q[s][0]), hn::Set(f, row.w));
        t.y[s] = hn::Mul(hn::Set(f, row.y), q[s][1]);
        t.z[s] = hn::Mul(hn::Set(f, row.z), q[s][2]);
      }
      const VF magnitude =
          hn::Add(hn::Add(hn::Mul(hn::Set(f, std::fabs(row.x)), reach_x),
                          hn::Mul(hn::Set(f, std::fabs(row.y)), reach_y)),
                  hn::Add(hn::Mul(hn::Set(f, std::fabs(row.z)), reach_z), hn::Set(f, std::fabs(row.w))));
      t.error = hn::Mul(hn::Set(f, kRounding), magnitude);
      return t;
    };
    const Terms tx = terms(e.x), ty = terms(e.y), tw = terms(e.w);
    VF left = hn::Set(f, kInfinity), top = left, least_w = left;
    VF right = hn::Set(f, -kInfinity), bottom = right;
    for (int k = 0; k < 8; ++k) {
      const auto sum = [&](const Terms& t)
                           HWY_ATTR { return hn::Add(hn::Add(t.x[k & 1], t.y[k >> 1 & 1]), t.z[k >> 2]); };
      const VF w = sum(tw);
      const VF over_w = hn::Div(hn::Set(f, 1.0f), w);
      const VF x = hn::Mul(sum(tx), over_w), y = hn::Mul(sum(ty), over_w);
      least_w = hn::Min(least_w, w);
      left = hn::Min(left, x), right = hn::Max(right, x), top = hn::Min(top, y), bottom = hn::Max(bottom, y);
    }
    const auto before = hn::Gt(least_w, hn::Add(tw.error, tw.error));
    const VF over_least = hn::Div(hn::Set(f, 1.0f), hn::Sub(least_w, tw.error));
    const VF widest = hn::Max(hn::Max(hn::Abs(left), hn::Abs(right)), hn::Max(hn::Abs(top), hn::Abs(bottom)));
    // The second term covers the pixel mapping's own rounding and a rasteriser's 8-bit subpixel grid.
    const VF slack =
        hn::Add(hn::Mul(hn::Add(hn::Max(tx.error, ty.error), hn::Mul(widest, tw.error)), over_least),
                hn::Set(f, 1.0f / 128));
    VF nearest = hn::Mul(over_least, hn::Set(f, 1 + 1e-6f));
    if (e.orthographic) {
      const Terms tn = terms(e.nearness);
      nearest = hn::Add(hn::Add(hn::Max(tn.x[0], tn.x[1]), hn::Max(tn.y[0], tn.y[1])),
                        hn::Add(hn::Max(tn.z[0], tn.z[1]), tn.error));
    }
    test_rectangles(tiles,
                    {hn::Sub(left, slack), hn::Add(right, slack), hn::Sub(top, slack), hn::Add(bottom, slack),
                     nearest, before},
                    count, visible + first);
  }
}
}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(query_all_boxes);

void query_boxes(const DepthTiles& tiles, const EyeProjection& projection, const BoxSpan& boxes,
                 std::uint8_t* visible) noexcept {
  HWY_DYNAMIC_DISPATCH(query_all_boxes)(tiles, projection, boxes, visible);
}

}  // namespace sightline::occlusion
#endif
