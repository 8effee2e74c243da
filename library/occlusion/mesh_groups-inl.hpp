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
#include <utility>

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

HWY_INLINE const float* sides_of_groups(const OccluderTopology& mesh, std::size_t first) {
  return &mesh.box[first / 16 * 96 + first % 16];
}

HWY_INLINE WideBoxes boxes_of_groups(const OccluderTopology& mesh, std::size_t first) {
  const F f;
  const float* box = sides_of_groups(mesh, first);
  return {{hn::Load(f, box), hn::Load(f, box + 16), hn::Load(f, box + 32)},
          {hn::Load(f, box + 48), hn::Load(f, box + 64), hn::Load(f, box + 80)}};
}

// Depths in steps of a sixteenth of an octave, fine enough for an order that only saves time.
HWY_INLINE VI depth_steps(VF depths) {
  const I i32;
  const VI bits = hn::BitCast(i32, depths);
  // As whole numbers negative floats fall where they rise.
  const VI turned = hn::And(hn::BroadcastSignBit(bits), hn::Set(i32, 0x7fffffff));
  return hn::ShiftRight<19>(hn::Xor(bits, turned));
}

// Appends those of groups first … that are in view, of which `count` are known. Writes up to a vector more.
// Depths are told apart from `nearest` on. Returns how many they are.
HWY_INLINE std::size_t append_groups(const OccluderTopology& mesh, std::size_t first, hn::Mask<F> in,
                                     VF depths, float nearest, std::size_t count, MeshScratch& s) {
  const F f;
  const I i32;
  const float* box = sides_of_groups(mesh, first);
  for (std::size_t axis = 0; axis < 3; ++axis, box += 16) {
    const VF middle = hn::Load(f, box), half = hn::Load(f, box + 48);
    store_kept(f, hn::Sub(middle, half), in, &s.box[axis][count]);
    store_kept(f, hn::Add(middle, half), in, &s.box[axis + 3][count]);
  }
  const VI steps = hn::Sub(depth_steps(depths), depth_steps(hn::Set(f, nearest))),
           step = hn::Min(hn::Max(steps, hn::Zero(i32)), hn::Set(i32, MeshScratch::kSteps - 1));
  const hn::RebindToUnsigned<F> u32;
  const auto these = hn::RebindMask(u32, in);
  store_kept(u32, hn::BitCast(u32, step), these, &s.step[count]);
  return store_kept(u32, hn::Iota(u32, static_cast<std::uint32_t>(first)), these, &s.group[count]);
}

// The order of the groups in view by their steps. Most meshes are small, and counting all steps would take
// longer than drawing them.
inline void sort_groups(MeshScratch& s) {
  constexpr std::size_t kFew = 16;
  if (s.in_view <= kFew) {
    for (std::uint32_t i = 0; i < s.in_view; ++i) {
      std::uint32_t at = i;
      for (; at > 0 && s.step[s.near_first[at - 1]] > s.step[i]; --at)
        s.near_first[at] = s.near_first[at - 1];
      s.near_first[at] = i;
    }
    return;
  }
  std::array<std::uint32_t, MeshScratch::kSteps> place{};
  for (std::size_t i = 0; i < s.in_view; ++i) ++place[s.step[i]];
  std::uint32_t sum = 0;
  for (std::uint32_t& its : place) its = std::exchange(sum, sum + its);
  for (std::uint32_t i = 0; i < s.in_view; ++i) s.near_first[place[s.step[i]]++] = i;
}

// The groups that the image may hold, near ones first. A group left out by mistake would only hide less.
HWY_NOINLINE void find_groups(DepthTiles& tiles, const OccluderTopology& mesh) {
  const F f;
  const ViewRows view = view_rows(tiles);
  MeshScratch& s = *tiles.mesh;
  s.in_view = 0;
  for (std::size_t first = 0; first < mesh.groups.size(); first += hn::Lanes(f)) {
    const WideBoxes boxes = boxes_of_groups(mesh, first);
    const VPoints q = about_eye(tiles.projection, boxes.middle);
    auto in = hn::FirstN(f, mesh.groups.size() - first);
    for (const Vec4& side : view.sides) {
      in = hn::And(in, hn::Ge(hn::Add(dot_row(side, q), size_along(side, boxes.half)), hn::Zero(f)));
      if (hn::AllFalse(f, in)) break;
    }
    if (hn::AllFalse(f, in)) continue;
    const VF depths = hn::Sub(dot_row(view.depth, q), size_along(view.depth, boxes.half));
    s.in_view += append_groups(mesh, first, in, depths, std::fabs(tiles.rays.near_plane.w), s.in_view, s);
  }
  sort_groups(s);
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
