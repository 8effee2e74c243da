// Which groups of a mesh's triangles a view may show, and in what order, for every SIMD width. Included by
// files that foreach_target compiles again and again.
#if defined(SIGHTLINE_OCCLUSION_MESH_GROUPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_MESH_GROUPS_INL
#undef SIGHTLINE_OCCLUSION_MESH_GROUPS_INL
#else
#define SIGHTLINE_OCCLUSION_MESH_GROUPS_INL
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "library/geometry/radix_sort.hpp"
#include "library/geometry/view_depth.hpp"
#include "library/occlusion/image-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// What a group's box must reach into, as rows whose product with a point about the eye is not negative there;
// and the row of depth along the view.
struct ViewRows {
  std::array<Vec4, 5> sides;
  Vec4 depth;
};

inline ViewRows view_rows(const DepthTiles& tiles) {
  const EyeProjection& e = tiles.projection;
  const auto width = static_cast<float>(tiles.width), top = static_cast<float>(tiles.first_row),
             bottom = static_cast<float>(tiles.end_row);
  const auto minus = [](float scale, const Vec4& a, const Vec4& b) {
    return Vec4{scale * a.x - b.x, scale * a.y - b.y, scale * a.z - b.z, scale * a.w - b.w};
  };
  const Vec4 above = minus(top, e.w, e.y), below = minus(bottom, e.w, e.y);
  return {{e.x, minus(width, e.w, e.x), Vec4{-above.x, -above.y, -above.z, -above.w}, below,
           tiles.rays.near_plane},
          e.orthographic ? Vec4{-e.nearness.x, -e.nearness.y, -e.nearness.z, 0} : e.w};
}

// A vector of boxes by middle and half size.
struct WideBoxes {
  VPoints middle, half;
};

// The most that a row adds on the way from a box's middle to a corner.
HWY_INLINE VF size_along(const Vec4& row, const VPoints& half) {
  return dot(half, std::array<float, 3>{std::fabs(row.x), std::fabs(row.y), std::fabs(row.z)});
}

HWY_INLINE WideBoxes boxes_of_groups(const OccluderTopology& mesh, std::size_t first) {
  const F f;
  const float* box = &mesh.box[first / 16 * 96 + first % 16];
  return {{hn::Load(f, box), hn::Load(f, box + 16), hn::Load(f, box + 32)},
          {hn::Load(f, box + 48), hn::Load(f, box + 64), hn::Load(f, box + 80)}};
}

// A depth in steps of a sixteenth of an octave, fine enough for an order that only saves time.
HWY_INLINE std::int32_t depth_step(float depth) {
  return static_cast<std::int32_t>(sortable(depth) >> 19);
}

// Appends those of groups first … whose bits are set. Depths are told apart from step `nearest_step` on.
HWY_INLINE void append_groups(MeshScratch& s, std::size_t first, const WideBoxes& boxes, VF nearest,
                              std::int32_t nearest_step, std::uint32_t those) {
  const F f;
  alignas(64) std::array<std::array<float, 16>, 7> out;
  hn::Store(hn::Sub(boxes.middle.x, boxes.half.x), f, out[0].data());
  hn::Store(hn::Sub(boxes.middle.y, boxes.half.y), f, out[1].data());
  hn::Store(hn::Sub(boxes.middle.z, boxes.half.z), f, out[2].data());
  hn::Store(hn::Add(boxes.middle.x, boxes.half.x), f, out[3].data());
  hn::Store(hn::Add(boxes.middle.y, boxes.half.y), f, out[4].data());
  hn::Store(hn::Add(boxes.middle.z, boxes.half.z), f, out[5].data());
  hn::Store(nearest, f, out[6].data());
  for (; those != 0; those &= those - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(those));
    const std::size_t place = s.group.size();
    const std::int32_t step = std::clamp(depth_step(out[6][i]) - nearest_step, 0, 255);
    s.near_first.push_back(static_cast<std::uint64_t>(step) << 56 | place);
    for (std::size_t side = 0; side < 6; ++side) s.box[side][place] = out[side][i];
    s.group.push_back(static_cast<std::uint32_t>(first + i));
  }
}

// The groups that the image may hold, near ones first. A group left out by mistake would only hide less.
HWY_NOINLINE void find_groups(DepthTiles& tiles, const OccluderTopology& mesh) {
  const F f;
  const ViewRows view = view_rows(tiles);
  MeshScratch& s = *tiles.mesh;
  const std::int32_t nearest_step = depth_step(std::fabs(tiles.rays.near_plane.w));
  s.group.clear(), s.near_first.clear();
  for (std::size_t first = 0; first < mesh.groups.size(); first += hn::Lanes(f)) {
    const WideBoxes boxes = boxes_of_groups(mesh, first);
    const VPoints q = about_eye(tiles.projection, boxes.middle);
    auto in = hn::FirstN(f, mesh.groups.size() - first);
    for (const Vec4& side : view.sides) {
      in = hn::And(in, hn::Ge(hn::Add(dot_row(side, q), size_along(side, boxes.half)), hn::Zero(f)));
      if (hn::AllFalse(f, in)) break;
    }
    if (hn::AllFalse(f, in)) continue;
    const VF nearest = hn::Sub(dot_row(view.depth, q), size_along(view.depth, boxes.half));
    if (const std::uint32_t those = bits_of(f, in))
      append_groups(s, first, boxes, nearest, nearest_step, those);
  }
  sort_by_high_bits(s.near_first, s.other, 56);
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
