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

// A vector of boxes about the eye.
struct BoxCorners {
  std::array<VPoints, 2> at;  // the least and the greatest
  VPoints reach;              // the largest coordinates, whatever their sign
};

HWY_INLINE BoxCorners corners_of(const EyeProjection& e, const std::array<const float*, 6>& from) {
  const F f;
  const auto corner = [&](std::size_t first) HWY_ATTR {
    return about_eye(
        e, {hn::LoadU(f, from[first]), hn::LoadU(f, from[first + 1]), hn::LoadU(f, from[first + 2])});
  };
  BoxCorners out{{corner(0), corner(3)}, {}};
  const auto& [low, high] = out.at;
  out.reach = {larger_of(low.x, high.x), larger_of(low.y, high.y), larger_of(low.z, high.z)};
  return out;
}

// The products of a row, and what rounding them, their sum and the row itself can lose.
struct Terms {
  VF x[2], y[2], z[2], error;
};

HWY_INLINE Terms terms_of(const Vec4& row, const BoxCorners& box) {
  const F f;
  Terms t;
  for (int s = 0; s < 2; ++s) {
    t.x[s] = hn::Add(hn::Mul(hn::Set(f, row.x), box.at[s].x), hn::Set(f, row.w));
    t.y[s] = hn::Mul(hn::Set(f, row.y), box.at[s].y);
    t.z[s] = hn::Mul(hn::Set(f, row.z), box.at[s].z);
  }
  const VF magnitude =
      hn::Add(hn::Add(hn::Mul(hn::Set(f, std::fabs(row.x)), box.reach.x),
                      hn::Mul(hn::Set(f, std::fabs(row.y)), box.reach.y)),
              hn::Add(hn::Mul(hn::Set(f, std::fabs(row.z)), box.reach.z), hn::Set(f, std::fabs(row.w))));
  t.error = hn::Mul(hn::Set(f, kRowRounding), magnitude);
  return t;
}

// The rectangles of boxes on the image, and their nearest depths.
HWY_INLINE Question question_of(const EyeProjection& e, const BoxCorners& box, float margin) {
  const F f;
  const Terms tx = terms_of(e.x, box), ty = terms_of(e.y, box), tw = terms_of(e.w, box);
  Rectangles on_image = no_rectangles();
  VF least_w = hn::Set(f, kInfinity);
  for (int k = 0; k < 8; ++k) {
    const auto sum = [&](const Terms& t)
                         HWY_ATTR { return hn::Add(hn::Add(t.x[k & 1], t.y[k >> 1 & 1]), t.z[k >> 2]); };
    const VF w = sum(tw);
    const VF over_w = hn::Div(hn::Set(f, 1.0f), w);
    least_w = hn::Min(least_w, w);
    add_point(on_image, hn::Mul(sum(tx), over_w), hn::Mul(sum(ty), over_w));
  }
  const auto before = hn::Gt(least_w, hn::Add(tw.error, tw.error));
  const VF over_least = hn::Div(hn::Set(f, 1.0f), hn::Sub(least_w, tw.error));
  // The second term covers the pixel mapping's own rounding and a rasteriser's 8-bit subpixel grid.
  const VF slack = hn::Add(
      hn::Mul(hn::Add(hn::Max(tx.error, ty.error), hn::Mul(widest_of(on_image), tw.error)), over_least),
      hn::Set(f, kSubpixelSlack + margin));
  VF nearest = hn::Mul(over_least, hn::Set(f, 1 + kReciprocalRounding));
  if (e.orthographic) {
    const Terms tn = terms_of(e.nearness, box);
    nearest = hn::Add(hn::Add(hn::Max(tn.x[0], tn.x[1]), hn::Max(tn.y[0], tn.y[1])),
                      hn::Add(hn::Max(tn.z[0], tn.z[1]), tn.error));
  }
  return {SIGHTLINE_MUTANT(asked_boxes_not_grown) ? on_image : grown(on_image, slack), nearest, before};
}

void query_all_boxes(const DepthTiles& tiles, const EyeProjection& e, const BoxSpan& boxes,
                     std::uint8_t* visible) {
  const std::array<const float*, 6> arrays{boxes.min_x, boxes.min_y, boxes.min_z,
                                           boxes.max_x, boxes.max_y, boxes.max_z};
  answer_all(tiles, arrays, boxes.count, visible,
             [&](const auto& from) HWY_ATTR { return question_of(e, corners_of(e, from), tiles.margin); });
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
