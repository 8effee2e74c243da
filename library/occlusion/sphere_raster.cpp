// Occluding spheres into the tiles: of each two discs that lie square to the view, whose depth is one and
// whose rows are a square root each. One goes through the centre and fills nearly the whole outline; one lies
// nearer and fills the middle.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "library/occlusion/depth_tiles.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/occlusion/sphere_raster.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/occlusion/depth_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// An ellipse of the image, its axes along the image's.
struct Disc {
  float x, y, radius_y, aspect;  // pixels; radius_x = aspect · radius_y
};

HWY_INLINE Spans spans_of(const Disc& disc, float first_y, float width) {
  const F f;
  Spans out;
  for (std::size_t i = 0; i < 2 * kTile; i += hn::Lanes(f)) {
    const VF offset = hn::Sub(hn::Add(hn::Set(f, first_y), hn::Load(f, kLine + i)), hn::Set(f, disc.y));
    const VF square = hn::Sub(hn::Set(f, disc.radius_y * disc.radius_y), hn::Mul(offset, offset));
    const VF half = hn::Mul(hn::Set(f, disc.aspect), hn::Sqrt(hn::Max(square, hn::Zero(f))));
    store_spans(hn::Sub(hn::Set(f, disc.x), half), hn::Add(hn::Set(f, disc.x), half),
                hn::Ge(square, hn::Zero(f)), width, i, out);
  }
  return out;
}

// What a metre square to the view becomes on the image.
struct Scales {
  float x = 0, y = 0;           // · 1/w (perspective) or · 1 (orthographic): pixels
  std::array<float, 3> axis{};  // along which the view looks, of unit length

  [[nodiscard]] float aspect() const { return x / y; }
};

Scales scales_of(const DepthTiles& tiles) {
  const EyeProjection& e = tiles.projection;
  using V = std::array<double, 3>;
  const auto to_v = [](const Vec4& r) { return V{r.x, r.y, r.z}; };
  const auto dot = [](const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  V axis = to_v(e.orthographic ? e.nearness : e.w);
  const double length = std::sqrt(dot(axis, axis)) * (e.orthographic ? -1 : 1);
  for (double& a : axis) a /= length;
  const auto square_to_view = [&](const V& v) {
    const double along = dot(v, axis);
    return V{v[0] - along * axis[0], v[1] - along * axis[1], v[2] - along * axis[2]};
  };
  const V x = square_to_view(to_v(e.x)), y = square_to_view(to_v(e.y));
  const double length_x = std::sqrt(dot(x, x)), length_y = std::sqrt(dot(y, y));
  // A sheared image has no discs of this kind.
  if (!(std::fabs(dot(x, y)) <= kMostShear * length_x * length_y)) return {};
  return {static_cast<float>(length_x * (1 - kDiscShrink)),
          static_cast<float>(length_y * (1 - kDiscShrink)),
          {static_cast<float>(axis[0]), static_cast<float>(axis[1]), static_cast<float>(axis[2])}};
}

// A disc of each sphere, `offset` radii before its centre.
struct Layer {
  float offset, radius;
};
constexpr Layer kLayers[2] = {{0.6f, 0.8f * (1 - kDiscRounding)}, {0, 1}};
// Pixels of radius: of a smaller sphere the nearer disc says too little, and of a smaller disc any.
constexpr float kLeastLayered = 2, kLeastDisc = 0.25f;

// A vector of discs, ready to be drawn.
struct Discs {
  alignas(64) std::array<float, 16> x, y, radius, near, clear;
};

HWY_INLINE void draw_discs(DepthTiles& tiles, const Discs& discs, float aspect, std::size_t count,
                           float least_radius, TileList<1>& list) {
  const auto width = static_cast<float>(tiles.width);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(discs.clear[i] > 0 && discs.radius[i] > least_radius && discs.radius[i] < 1e6f)) continue;
    const Disc disc{discs.x[i], discs.y[i], discs.radius[i], aspect};
    const float wide = disc.radius_y * aspect;
    const TileRange range =
        tiles_of(tiles, disc.x - wide, disc.x + wide, disc.y - disc.radius_y, disc.y + disc.radius_y);
    if (hidden_tiles(tiles, range, discs.near[i])) continue;
    list_spans<1>(
        tiles, {{discs.near[i]}, {0}, {0}}, range,
        [&](float first_y) HWY_ATTR { return spans_of(disc, first_y, width); }, list);
  }
  draw_listed(tiles, list);
}

// A vector of spheres about the eye, as they are drawn.
struct DrawnSpheres {
  VPoints centre;
  VF radius;
};

HWY_INLINE DrawnSpheres spheres_of(const EyeProjection& e, std::span<const Sphere> spheres) {
  const F f;
  alignas(64) std::array<std::array<float, 16>, 4> in;
  for (std::size_t i = 0; i < hn::Lanes(f); ++i) {
    const Sphere& s = spheres[std::min(i, spheres.size() - 1)];
    in[0][i] = s.centre.x, in[1][i] = s.centre.y, in[2][i] = s.centre.z, in[3][i] = s.radius;
  }
  return {about_eye(e, {hn::Load(f, in[0].data()), hn::Load(f, in[1].data()), hn::Load(f, in[2].data())}),
          hn::Load(f, in[3].data())};
}

HWY_INLINE void find_discs(const DepthTiles& tiles, const DrawnSpheres& s, const Scales& scales,
                           const Layer& layer, Discs& out) {
  const F f;
  const EyeProjection& e = tiles.projection;
  const auto nearer = [&](VF at, float axis) HWY_ATTR {
    return hn::Sub(at, hn::Mul(s.radius, hn::Set(f, layer.offset * axis)));
  };
  const VPoints q{nearer(s.centre.x, scales.axis[0]), nearer(s.centre.y, scales.axis[1]),
                  nearer(s.centre.z, scales.axis[2])};
  const VF r = hn::Mul(s.radius, hn::Set(f, layer.radius));
  const VF over_w = hn::Div(hn::Set(f, 1.0f), dot_row(e.w, q));
  const VF x = hn::Mul(dot_row(e.x, q), over_w), y = hn::Mul(dot_row(e.y, q), over_w);
  const VF nearness = e.orthographic ? dot_row(e.nearness, q) : over_w;
  const VF reach = hn::Add(hn::Abs(q.x), hn::Add(hn::Abs(q.y), hn::Abs(q.z)));
  // The radius along y, less what rounding asks along either axis.
  const VF inset = inset_of(tiles, hn::Max(hn::Abs(x), hn::Abs(y)));
  const VF radius = hn::Sub(hn::Mul(hn::Mul(r, hn::Set(f, scales.y)), over_w),
                            hn::Mul(inset, hn::Set(f, 1 + 1 / scales.aspect())));
  // The whole sphere in front of the near plane: of one that it cuts, the inside is seen.
  const VF needed =
      hn::Add(hn::Mul(s.radius, hn::Set(f, 1 + kSphereClearance)), hn::Mul(reach, hn::Set(f, kSphereReach)));
  const VF backwards = hn::Mul(hn::Set(f, kNearnessRounding), e.orthographic ? reach : hn::Abs(nearness));
  hn::Store(x, f, out.x.data());
  hn::Store(y, f, out.y.data());
  hn::Store(radius, f, out.radius.data());
  hn::Store(hn::Sub(nearness, backwards), f, out.near.data());
  hn::Store(hn::Sub(dot_row(tiles.rays.near_plane, s.centre), needed), f, out.clear.data());
}

void draw_all_spheres(DepthTiles& tiles, std::span<const Sphere> spheres) {
  const std::size_t lanes = hn::Lanes(F());
  const Scales scales = scales_of(tiles);
  if (!(scales.x > 0 && scales.y > 0)) return;
  Discs discs;
  TileList<1> list;
  for (std::size_t first = 0; first < spheres.size(); first += lanes) {
    const std::size_t count = std::min(lanes, spheres.size() - first);
    const DrawnSpheres some = spheres_of(tiles.projection, spheres.subspan(first, count));
    for (const Layer& layer : kLayers) {
      find_discs(tiles, some, scales, layer, discs);
      draw_discs(tiles, discs, scales.aspect(), count, layer.offset > 0 ? kLeastLayered : kLeastDisc, list);
    }
  }
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(draw_all_spheres);

void draw_spheres(DepthTiles& tiles, std::span<const Sphere> spheres) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_all_spheres)(tiles, spheres);
  note_drawn(tiles, spheres.size());
}

}  // namespace sightline::occlusion
#endif
