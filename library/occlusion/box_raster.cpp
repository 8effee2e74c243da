// Occluding boxes into the tiles.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "library/occlusion/depth_tiles.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/occlusion/box_raster.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/occlusion/depth_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

template <std::size_t kCount>
using Vectors = std::array<std::array<float, 16>, kCount>;

// A vector of boxes, ready to be drawn. Corner c of a box has the greater x, y, z where bit 0, 1, 2 is set.
struct ProjectedBoxes {
  alignas(64) Vectors<6> sides;  // about the eye
  alignas(64) Vectors<8> x, y;   // of the corners
  // The outline, two edges along each axis: x = at + slope·y; what does not bound a side lies at infinity.
  alignas(64) Vectors<6> slope, left_at, right_at;
  alignas(64) Vectors<3> at, across, down;  // of the plane that looks at the eye, by axis
  alignas(64) std::array<float, 16> left, right, top, bottom, nearest;
  alignas(64) std::array<std::int32_t, 16> begin_x, end_x, begin_y, end_y;  // tiles
  std::uint32_t drawn, cut;  // a bit a box: to be drawn as it stands; face by face
};

// Which faces surely look at the eye, by axis: the one of the lesser coordinate, or of the greater. A bit a
// box, and no masks: clang 19 never ends with what find_edges() makes of those of AVX-512.
struct Facing {
  std::array<std::uint32_t, 3> low, high;
};

// The faces and their planes; `grazing` is set where one looks at the eye, but not surely.
HWY_INLINE Facing find_faces(const DepthTiles& tiles, VF nearest, std::uint32_t& grazing,
                             ProjectedBoxes& out) {
  const F f;
  const PixelRays& rays = tiles.rays;
  const bool orthographic = tiles.projection.orthographic;
  const VF zero = hn::Zero(f);
  Facing facing;
  grazing = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const VF low = hn::Load(f, out.sides[a].data()), high = hn::Load(f, out.sides[a + 3].data());
    const VF margin = hn::Add(hn::Set(f, kFaceDistance),
                              hn::Mul(hn::Set(f, kFacePart), hn::Max(hn::Abs(low), hn::Abs(high))));
    const VF forward = hn::Set(f, rays.forward[a]);
    const auto low_looks = orthographic ? hn::Gt(forward, hn::Set(f, kFaceSine)) : hn::Gt(low, margin);
    const auto high_looks =
        orthographic ? hn::Lt(forward, hn::Set(f, -kFaceSine)) : hn::Lt(high, hn::Neg(margin));
    facing.low[a] = bits_of(f, low_looks), facing.high[a] = bits_of(f, high_looks);
    const auto any = orthographic ? hn::Ne(forward, zero) : hn::Or(hn::Gt(low, zero), hn::Lt(high, zero));
    const auto sure = hn::Or(low_looks, high_looks);
    grazing |= bits_of(f, hn::AndNot(sure, any));
    const VF at = hn::IfThenElse(low_looks, low, high);
    const VF scale = hn::Div(hn::Set(f, 1.0f), orthographic ? forward : at);
    const VF across = hn::Mul(hn::Set(f, rays.across[a]), scale),
             along = hn::Mul(hn::Set(f, rays.down[a]), scale);
    const VF start = orthographic ? hn::Sub(hn::Set(f, rays.at[a]), at) : hn::Set(f, rays.at[a]);
    const VF moved = moved_back(tiles, hn::Mul(start, scale), across, along, nearest);
    // A plane that does not look at the eye is in front of all others.
    hn::Store(hn::IfThenElseZero(sure, across), f, out.across[a].data());
    hn::Store(hn::IfThenElseZero(sure, along), f, out.down[a].data());
    hn::Store(hn::IfThenElse(sure, moved, hn::Set(f, kInfinity)), f, out.at[a].data());
  }
  if (SIGHTLINE_MUTANT(occluders_without_a_face)) facing.high[1] = 0;
  return facing;
}

// An edge along axis a of each box, and which of the four: at the high face of b, of c.
struct EdgePlace {
  std::size_t a, b, c;
  hn::Mask<F> high_b, high_c;
};

HWY_INLINE VF corner_of(const Vectors<8>& of, const EdgePlace& edge, std::size_t along) {
  const auto at = [&](std::size_t at_b, std::size_t at_c) HWY_ATTR {
    return hn::Load(F(), of[along << edge.a | at_b << edge.b | at_c << edge.c].data());
  };
  return hn::IfThenElse(edge.high_b, hn::IfThenElse(edge.high_c, at(1, 1), at(1, 0)),
                        hn::IfThenElse(edge.high_c, at(0, 1), at(0, 0)));
}

// Bits of the boxes whose edge bounds them to the right, to the left.
struct Bounded {
  std::uint32_t right = 0, left = 0;
};

// Edges that rise along the axis at the outline's right where `up` says so; of those that `looks` names.
HWY_INLINE Bounded store_edges(const EdgePlace& place, hn::Mask<F> looks, hn::Mask<F> up, VF inset,
                               std::size_t edge, ProjectedBoxes& out) {
  const F f;
  const VF ax = corner_of(out.x, place, 0), ay = corner_of(out.y, place, 0), bx = corner_of(out.x, place, 1),
           by = corner_of(out.y, place, 1);
  const VF rise = hn::Sub(by, ay), slope = hn::Div(hn::Sub(bx, ax), rise),
           at = hn::Sub(ax, hn::Mul(ay, slope));
  const VF inwards = hn::Mul(inset, hn::Add(hn::Set(f, 1.0f), hn::Abs(slope)));
  const auto interior_left = hn::Xor(hn::Gt(rise, hn::Zero(f)), up);
  const auto steep = hn::And(looks, hn::Ge(hn::Abs(rise), hn::Set(f, kFlatEdge)));
  const VF none = hn::Set(f, kInfinity);
  hn::Store(hn::IfThenElseZero(steep, slope), f, out.slope[edge].data());
  const auto on_right = hn::And(steep, interior_left), on_left = hn::AndNot(interior_left, steep);
  hn::Store(hn::IfThenElse(on_right, hn::Sub(at, inwards), none), f, out.right_at[edge].data());
  hn::Store(hn::IfThenElse(on_left, hn::Add(at, inwards), hn::Neg(none)), f, out.left_at[edge].data());
  return {bits_of(f, on_right), bits_of(f, on_left)};
}

// The outline of a box by which faces look at the eye (after Schmalstieg & Tobler 1999): the edges between a
// face that does and one that does not. Along an axis a there are two or none, and which ones, the faces of
// the other axes b and c tell: edge (j, k) lies between the low or high face of b, as j says, and that of c.
// Returns a bit a box: it has an edge on either side.
HWY_INLINE std::uint32_t find_edges(const Facing& facing, bool turns_right, VF inset, ProjectedBoxes& out) {
  const F f;
  Bounded all;
  const std::uint32_t turns = turns_right ? ~0u : 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    const std::uint32_t looks_b = facing.low[b] | facing.high[b], looks_c = facing.low[c] | facing.high[c];
    for (std::size_t e = 0; e < 2; ++e) {
      // The first edge lies at the face of b that looks and away from that of c, the second the other way
      // round; where only one of both looks, both edges lie at it.
      const std::uint32_t j = e == 0 ? facing.high[b] : facing.high[b] ^ looks_c,
                          k = e == 0 ? (looks_b & facing.low[c]) | (~looks_b & facing.high[c])
                                     : facing.high[c] | ~looks_c;
      // Counterclockwise round the face that looks, the outline runs up the axis at one side of it.
      const std::uint32_t by_b = e == 0 ? looks_b : ~looks_c, up = by_b ^ j ^ k ^ turns;
      const Bounded its = store_edges({a, b, c, mask_of(f, j), mask_of(f, k)}, mask_of(f, looks_b | looks_c),
                                      mask_of(f, up), inset, 2 * a + e, out);
      all.right |= its.right, all.left |= its.left;
    }
  }
  return all.right & all.left;
}

// Sides about the eye. Returns a bit a box: its sides are in order, and none is so far away that distances
// from planes along it round to more than a box.
HWY_INLINE std::uint32_t load_sides(const EyeProjection& e, const Box* boxes, std::size_t count,
                                    std::array<VPoints, 2>& at, ProjectedBoxes& out) {
  const F f;
  for (std::size_t i = 0; i < hn::Lanes(f); ++i) {
    const Box& box = boxes[std::min(i, count - 1)];
    out.sides[0][i] = box.min.x, out.sides[1][i] = box.min.y, out.sides[2][i] = box.min.z;
    out.sides[3][i] = box.max.x, out.sides[4][i] = box.max.y, out.sides[5][i] = box.max.z;
  }
  for (std::size_t s = 0; s < 2; ++s) {
    auto* side = &out.sides[3 * s];
    at[s] =
        about_eye(e, {hn::Load(f, side[0].data()), hn::Load(f, side[1].data()), hn::Load(f, side[2].data())});
    hn::Store(at[s].x, f, side[0].data());
    hn::Store(at[s].y, f, side[1].data());
    hn::Store(at[s].z, f, side[2].data());
  }
  const VF reach = hn::Set(f, static_cast<float>(kWorldReach));
  const auto in_order = [&](VF low, VF high) HWY_ATTR {
    return hn::And(hn::Le(low, high), hn::And(hn::Ge(low, hn::Neg(reach)), hn::Le(high, reach)));
  };
  const auto& [low, high] = at;
  return bits_of(
             f, hn::And(hn::And(in_order(low.x, high.x), in_order(low.y, high.y)), in_order(low.z, high.z))) &
         ((1u << count) - 1);
}

// Boxes on the image.
struct BoxImages {
  Rectangles outline;
  VF clear, nearest;  // the least distance before the near plane, the greatest nearness
};

HWY_INLINE BoxImages project_corners(const DepthTiles& tiles, const std::array<VPoints, 2>& at,
                                     ProjectedBoxes& out) {
  const F f;
  const EyeProjection& e = tiles.projection;
  BoxImages image{no_rectangles(), hn::Set(f, kInfinity), hn::Set(f, -kInfinity)};
  for (std::size_t c = 0; c < 8; ++c) {
    const VPoints q{at[c & 1].x, at[c >> 1 & 1].y, at[c >> 2].z};
    image.clear = hn::Min(image.clear, dot_row(tiles.rays.near_plane, q));
    const VF over_w = hn::Div(hn::Set(f, 1.0f), dot_row(e.w, q));
    const VF x = hn::Mul(dot_row(e.x, q), over_w), y = hn::Mul(dot_row(e.y, q), over_w);
    image.nearest = hn::Max(image.nearest, e.orthographic ? dot_row(e.nearness, q) : over_w);
    add_point(image.outline, x, y);
    hn::Store(x, f, out.x[c].data());
    hn::Store(y, f, out.y[c].data());
  }
  return image;
}

HWY_INLINE void store_tiles(const PixelBounds& pixels, ProjectedBoxes& out) {
  const I i32;
  const auto tile = [&](VF pixel) HWY_ATTR { return hn::ShiftRight<3>(hn::ConvertTo(i32, pixel)); };
  const VI one = hn::Set(i32, 1);
  hn::Store(tile(pixels.x0), i32, out.begin_x.data());
  hn::Store(tile(pixels.y0), i32, out.begin_y.data());
  hn::Store(hn::Add(tile(pixels.x1), one), i32, out.end_x.data());
  hn::Store(hn::Add(tile(pixels.y1), one), i32, out.end_y.data());
}

HWY_INLINE void project_boxes(const DepthTiles& tiles, const Box* boxes, std::size_t count,
                              ProjectedBoxes& out) {
  const F f;
  std::array<VPoints, 2> at;
  const std::uint32_t some = load_sides(tiles.projection, boxes, count, at, out);
  const BoxImages image = project_corners(tiles, at, out);
  const VF widest = widest_of(image.outline), inset = inset_of(tiles, widest);
  std::uint32_t grazing = 0;
  const Facing facing = find_faces(tiles, image.nearest, grazing, out);
  const std::uint32_t bounded = find_edges(facing, tiles.rays.turns_right, inset, out);
  const Rectangles outline = shrunk(image.outline, inset);
  store(outline, out, 0);
  hn::Store(image.nearest, f, out.nearest.data());
  const PixelBounds pixels = pixel_bounds(tiles, outline);
  store_tiles(pixels, out);
  const std::uint32_t before = bits_of(f, hn::Ge(image.clear, hn::Zero(f)));
  // Without numbers there is no saying where a box ends.
  const std::uint32_t numbers = bits_of(f, hn::Lt(widest, hn::Set(f, kInfinity)));
  out.drawn = some & before & ~grazing & bits_of(f, pixels.some) & numbers & bounded;
  out.cut = some & ~(before & ~grazing);
}

// Lists box i.
HWY_INLINE void list_box(DepthTiles& tiles, const ProjectedBoxes& b, std::size_t i, TileList<3>& list) {
  const TileRange range{static_cast<std::uint32_t>(b.begin_x[i]), static_cast<std::uint32_t>(b.end_x[i]),
                        static_cast<std::uint32_t>(b.begin_y[i]), static_cast<std::uint32_t>(b.end_y[i])};
  // A box behind what is drawn already changes nothing.
  if (hidden_tiles(tiles, range, b.nearest[i])) return;
  const Planes<3> planes{{b.at[0][i], b.at[1][i], b.at[2][i]},
                         {b.across[0][i], b.across[1][i], b.across[2][i]},
                         {b.down[0][i], b.down[1][i], b.down[2][i]}};
  const auto width = static_cast<float>(tiles.width);
  const auto spans_from = [&](float first_y) HWY_ATTR { return spans_of<6>(b, i, first_y, width); };
  list_spans<3>(tiles, planes, range, spans_from, list);
}

HWY_INLINE void draw_projected(DepthTiles& tiles, const ProjectedBoxes& b, TileList<3>& list) {
  for (std::uint32_t rest = b.cut; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    draw_clipped_box(tiles, {b.sides[0][i], b.sides[1][i], b.sides[2][i]},
                     {b.sides[3][i], b.sides[4][i], b.sides[5][i]});
  }
  for (std::uint32_t rest = b.drawn; rest != 0; rest &= rest - 1)
    list_box(tiles, b, static_cast<std::size_t>(std::countr_zero(rest)), list);
  draw_listed(tiles, list);
}

void draw_all_boxes(DepthTiles& tiles, std::span<const Box> boxes) {
  const F f;
  ProjectedBoxes b;
  TileList<3> list;
  for (std::size_t first = 0; first < boxes.size(); first += hn::Lanes(f)) {
    project_boxes(tiles, &boxes[first], std::min(hn::Lanes(f), boxes.size() - first), b);
    draw_projected(tiles, b, list);
  }
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(draw_all_boxes);

void draw_boxes(DepthTiles& tiles, std::span<const Box> boxes) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_all_boxes)(tiles, boxes);
  note_drawn(tiles, boxes.size());
}

}  // namespace sightline::occlusion
#endif
