#include <sightline/frustum.hpp>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/frustum/frustum_cull.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/geometry/box_reader.hpp"
#include "library/geometry/error_bounds.hpp"
#include "library/geometry/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::frustum::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::ScalableTag<float>;
using U = hn::RebindToUnsigned<F>;
using VF = hn::Vec<F>;

using geometry::BoxSpan;
using geometry::SphereSpan;
using Points = geometry::HWY_NAMESPACE::Points<VF>;

// A plane spread over the lanes, held in registers through a loop.
struct WidePlane {
  Points normal;
  VF distance;
};

HWY_INLINE WidePlane spread(const Plane& plane) {
  const F f;
  return {{hn::Set(f, plane.normal.x), hn::Set(f, plane.normal.y), hn::Set(f, plane.normal.z)},
          hn::Set(f, plane.distance)};
}

// signed_distance() of a vector of points, with its roundings.
HWY_INLINE VF distance(const WidePlane& plane, const Points& p) {
  return hn::Add(geometry::HWY_NAMESPACE::dot(plane.normal, p), plane.distance);
}

// What is looked at together: a cache line of each array.
constexpr std::size_t kGroup = 16;
constexpr std::size_t kVectors = (kGroup + hn::MaxLanes(F()) - 1) / hn::MaxLanes(F());

// Writes the indices of what no plane has behind it. sides(i) and others(i) tell of the vector from i on what
// lies behind one of some planes; `keep` of one element, where they fill no group. A group that the first
// planes reject is done with: next to none where ids lie anyhow, most where neighbours have neighbouring ids,
// so that the branch is foreseen.
template <class Sides, class Others, class Keep>
HWY_INLINE std::size_t pack(std::size_t count, const float* array, ObjectId* HWY_RESTRICT out,
                            const Sides& sides, const Others& others, const Keep& keep) {
  const F f;
  const U u;
  const std::size_t lanes = hn::Lanes(f);
  // By value, so that neither count lives in memory through the loop below.
  const auto one_by_one = [&keep, out](std::size_t first, std::size_t end, std::size_t kept) {
    for (std::size_t i = first; i < end; ++i) {
      out[kept] = static_cast<ObjectId>(i);
      kept += keep(i) ? 1 : 0;
    }
    return kept;
  };
  // Large arrays start alike within a cache line: from the next line on no load crosses two.
  const std::size_t behind_line = reinterpret_cast<std::uintptr_t>(array) / sizeof(float) % lanes;
  std::size_t i = std::min(count, (lanes - behind_line) % lanes);
  std::size_t kept = one_by_one(0, i, 0);
  auto first_ids = hn::Iota(u, static_cast<std::uint32_t>(i));
  const auto step = hn::Set(u, static_cast<std::uint32_t>(kGroup));
  for (; i + kGroup <= count; i += kGroup) {
    const auto group_ids = first_ids;
    first_ids = hn::Add(first_ids, step);
    hn::Mask<F> gone[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) gone[v] = sides(i + v * lanes);
    auto all = gone[0];
    for (std::size_t v = 1; v < kVectors; ++v) all = hn::And(all, gone[v]);
    if (hn::AllTrue(f, all)) continue;
    for (std::size_t v = 0; v < kVectors; ++v) {
      const auto left = hn::Not(hn::Or(gone[v], others(i + v * lanes)));
      const auto ids = hn::Add(group_ids, hn::Set(u, static_cast<std::uint32_t>(v * lanes)));
      kept += geometry::HWY_NAMESPACE::store_kept(u, ids, hn::RebindMask(u, left), out + kept);
    }
  }
  return one_by_one(i, count, kept);
}

// The corner of each box that lies farthest along a plane's normal: one choice for all boxes.
struct Nearest {
  const float *x, *y, *z;

  Nearest(const Plane& plane, const BoxSpan& b)
      : x(plane.normal.x >= 0 ? b.max_x : b.min_x),
        y(plane.normal.y >= 0 ? b.max_y : b.min_y),
        z(plane.normal.z >= 0 ? b.max_z : b.min_z) {}
};

std::size_t cull_boxes(const Frustum& frustum, const BoxSpan& boxes, ObjectId* out) {
  const F f;
  const auto& p = frustum.planes;
  const WidePlane p0 = spread(p[0]), p1 = spread(p[1]), p2 = spread(p[2]), p3 = spread(p[3]),
                  p4 = spread(p[4]), p5 = spread(p[5]);
  const Nearest n0(p[0], boxes), n1(p[1], boxes), n2(p[2], boxes), n3(p[3], boxes), n4(p[4], boxes),
      n5(p[5], boxes);
  const auto behind = [f](const WidePlane& plane, const Nearest& n, std::size_t i) HWY_ATTR {
    const Points corner{hn::LoadU(f, n.x + i), hn::LoadU(f, n.y + i), hn::LoadU(f, n.z + i)};
    return hn::Lt(distance(plane, corner), hn::Zero(f));
  };
  return pack(
      boxes.count, boxes.min_x, out,
      // Left and right reject what lies behind the eye, too.
      [&](std::size_t i) HWY_ATTR { return hn::Or(behind(p0, n0, i), behind(p1, n1, i)); },
      [&](std::size_t i) HWY_ATTR {
        return hn::Or(hn::Or(behind(p2, n2, i), behind(p3, n3, i)),
                      hn::Or(behind(p4, n4, i), behind(p5, n5, i)));
      },
      [&](std::size_t i) {
        return overlaps(frustum, Box{{boxes.min_x[i], boxes.min_y[i], boxes.min_z[i]},
                                     {boxes.max_x[i], boxes.max_y[i], boxes.max_z[i]}});
      });
}

std::size_t cull_spheres(const Frustum& frustum, const SphereSpan& s, ObjectId* out) {
  const F f;
  const auto& p = frustum.planes;
  const WidePlane p0 = spread(p[0]), p1 = spread(p[1]), p2 = spread(p[2]), p3 = spread(p[3]),
                  p4 = spread(p[4]), p5 = spread(p[5]);
  const auto at = [&](std::size_t i) HWY_ATTR {
    return Points{hn::LoadU(f, s.x + i), hn::LoadU(f, s.y + i), hn::LoadU(f, s.z + i)};
  };
  const auto deepest = [&](std::size_t i) HWY_ATTR {
    return hn::Neg(hn::Mul(hn::LoadU(f, s.radius + i), hn::Set(f, geometry::kRadiusGrowth)));
  };
  return pack(
      s.count, s.x, out,
      [&](std::size_t i) HWY_ATTR {
        const Points c = at(i);
        const VF d = deepest(i);
        return hn::Or(hn::Lt(distance(p0, c), d), hn::Lt(distance(p1, c), d));
      },
      [&](std::size_t i) HWY_ATTR {
        const Points c = at(i);
        const VF d = deepest(i);
        return hn::Or(hn::Or(hn::Lt(distance(p2, c), d), hn::Lt(distance(p3, c), d)),
                      hn::Or(hn::Lt(distance(p4, c), d), hn::Lt(distance(p5, c), d)));
      },
      [&](std::size_t i) {
        return overlaps(frustum, Sphere{{s.x[i], s.y[i], s.z[i]}, s.radius[i]});
      });
}

}  // namespace sightline::frustum::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {
namespace frustum {
HWY_EXPORT(cull_boxes);
HWY_EXPORT(cull_spheres);

namespace {

std::size_t cull(const Frustum& frustum, const geometry::BoxSpan& boxes, ObjectId* out) {
  return HWY_DYNAMIC_DISPATCH(cull_boxes)(frustum, boxes, out);
}
std::size_t cull(const Frustum& frustum, const geometry::SphereSpan& spheres, ObjectId* out) {
  return HWY_DYNAMIC_DISPATCH(cull_spheres)(frustum, spheres, out);
}

Status check(std::size_t count, bool sound, std::span<ObjectId> visible) {
  if (!sound) return {StatusCode::bad_argument, "cull: a pointer is null or a stride too short"};
  if (count >= kNoObject) return {StatusCode::bad_argument, "cull: expected fewer than 2^32 - 1 elements"};
  if (visible.size() < count + kCullPadding)
    return {StatusCode::buffer_too_small, "cull: expected room for the count and kCullPadding indices"};
  return {};
}

// Lays out a block at a time, and counts its indices on from where it begins.
template <class Block, class LayOut>
std::size_t cull_blocks(const Frustum& frustum, std::size_t count, ObjectId* out, const LayOut& lay_out) {
  Block block;
  std::size_t kept = 0;
  for (std::size_t first = 0; first < count; first += geometry::kBlock) {
    const std::size_t size = std::min(geometry::kBlock, count - first);
    const std::size_t more = cull(frustum, lay_out(first, size, block), out + kept);
    for (std::size_t i = kept; i < kept + more; ++i) out[i] += static_cast<ObjectId>(first);
    kept += more;
  }
  return kept;
}

}  // namespace
}  // namespace frustum

using namespace geometry;

Result<std::size_t> cull_boxes(const Frustum& frustum, const BoxView& boxes,
                               std::span<ObjectId> visible) noexcept {
  if (const Status sound = frustum::check(boxes.size(), boxes.sound(), visible); !sound) return sound;
  if (BoxSpan arrays; BoxReader::lies_in_arrays(boxes, frustum.origin, arrays))
    return frustum::cull(frustum, arrays, visible.data());
  return frustum::cull_blocks<BoxBlock>(
      frustum, boxes.size(), visible.data(), [&](std::size_t first, std::size_t count, BoxBlock& block) {
        return BoxReader::lay_out(boxes, first, count, frustum.origin, block);
      });
}

Result<std::size_t> cull_spheres(const Frustum& frustum, const SphereView& spheres,
                                 std::span<ObjectId> visible) noexcept {
  if (const Status sound = frustum::check(spheres.size(), spheres.sound(), visible); !sound) return sound;
  if (SphereSpan arrays; BoxReader::lies_in_arrays(spheres, arrays))
    return frustum::cull(frustum, arrays, visible.data());
  return frustum::cull_blocks<SphereBlock>(frustum, spheres.size(), visible.data(),
                                           [&](std::size_t first, std::size_t count, SphereBlock& block) {
                                             return BoxReader::lay_out(spheres, first, count, block);
                                           });
}

}  // namespace sightline
#endif
