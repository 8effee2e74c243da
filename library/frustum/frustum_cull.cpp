#include <sightline/frustum.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>

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
using geometry::HWY_NAMESPACE::bits_of;
using geometry::HWY_NAMESPACE::lowest;
using geometry::HWY_NAMESPACE::packed;
using geometry::HWY_NAMESPACE::spread;
using Points = geometry::HWY_NAMESPACE::Points<VF>;
using WidePlane = geometry::HWY_NAMESPACE::WidePlane<VF>;

// What is looked at together: a cache line of each array.
constexpr std::size_t kGroup = 16;
constexpr std::size_t kVectors = (kGroup + hn::MaxLanes(F()) - 1) / hn::MaxLanes(F());
constexpr std::size_t kRun = 64;  // groups

// The vector from element i on of an array.
struct Whole {
  std::size_t i;
  HWY_INLINE VF operator()(const float* array) const { return hn::LoadU(F(), array + i); }
};
// The same of fewer elements than a vector's, beyond which nothing is read.
struct Part {
  std::size_t i, count;
  HWY_INLINE VF operator()(const float* array) const {
    const F f;
    if constexpr (hn::MaxLanes(F()) > 4) {
      return hn::MaskedLoad(hn::FirstN(f, count), f, array + i);
    } else {
      HWY_ALIGN float room[hn::MaxLanes(F())] = {};
      std::copy_n(array + i, count, room);
      return hn::Load(f, room);
    }
  }
};

// Writes those of a group's indices whose bits are set, and returns how many.
HWY_INLINE std::size_t store_group(std::uint32_t those, std::uint32_t first, ObjectId* HWY_RESTRICT out) {
  const U u;
  const std::size_t lanes = hn::Lanes(u);
  const auto steps = hn::Iota(u, 0);
  std::size_t kept = 0;
  for (std::size_t v = 0; v < kVectors; ++v) {
    const std::uint32_t bits = those >> v * lanes & ((1u << lanes) - 1);
    const auto ids = hn::Add(steps, hn::Set(u, first + static_cast<std::uint32_t>(v * lanes)));
    hn::StoreU(packed(u, ids, bits), u, out + kept);
    kept += static_cast<std::size_t>(std::popcount(bits));
  }
  return kept;
}

// Writes the indices of what no plane has behind it, lying as deep as deepest(at) tells of the vector that
// `at` reads. sides(at, than) and others(at, than) are the lowest() of some planes' distances. A group that
// the first planes reject is done with: next to none where ids lie anyhow, most where neighbours have
// neighbouring ids, so that the branch is foreseen. Where an index is written hangs on all before it: of a
// run of groups those that the first planes leave are listed with what is kept of them, none waiting for
// another, and then written.
template <class Deepest, class Sides, class Others>
HWY_INLINE std::size_t pack(std::size_t count, const float* array, ObjectId* HWY_RESTRICT out,
                            const Deepest& deepest, const Sides& sides, const Others& others) {
  const F f;
  const U u;
  const std::size_t lanes = hn::Lanes(f);
  // By value, so that neither count lives in memory through the loop below.
  const auto some = [=](std::size_t first, std::size_t end, std::size_t kept) HWY_ATTR {
    for (; first < end; first += lanes) {
      const Part at{first, std::min(lanes, end - first)};
      const VF deep = deepest(at);
      const auto gone = hn::Lt(others(at, sides(at, deep)), deep);
      const auto left = hn::And(hn::Not(hn::RebindMask(u, gone)), hn::FirstN(u, at.count));
      const auto ids = hn::Iota(u, static_cast<std::uint32_t>(first));
      kept += geometry::HWY_NAMESPACE::store_kept(u, ids, left, out + kept);
    }
    return kept;
  };
  std::array<std::uint32_t, kRun> at, kept_of;  // of groups that are listed: the first index, and a bit each
  // Lists a group unless the first planes reject it, and returns how many are.
  const auto list = [&](std::size_t i, std::size_t listed) HWY_ATTR {
    VF low[kVectors], deep[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Whole from{i + v * lanes};
      deep[v] = deepest(from);
      low[v] = sides(from, deep[v]);
    }
    auto gone = hn::Lt(low[0], deep[0]);
    for (std::size_t v = 1; v < kVectors; ++v) gone = hn::And(gone, hn::Lt(low[v], deep[v]));
    if (hn::AllTrue(f, gone)) return listed;
    std::uint32_t left = 0;
    for (std::size_t v = 0; v < kVectors; ++v) {
      const auto behind = hn::Lt(others(Whole{i + v * lanes}, low[v]), deep[v]);
      left |= bits_of(f, hn::Not(behind)) << v * lanes;
    }
    at[listed] = static_cast<std::uint32_t>(i);
    kept_of[listed] = left;
    return listed + 1;
  };
  // Arrays of Boxes, and large ones of a heap, start alike within a cache line: from the next one on no load
  // crosses two.
  const std::size_t behind_line = reinterpret_cast<std::uintptr_t>(array) / sizeof(float) % lanes;
  std::size_t i = std::min(count, (lanes - behind_line) % lanes);
  std::size_t kept = i > 0 ? some(0, i, 0) : 0;
  while (i + kGroup <= count) {
    const std::size_t end = i + std::min(kRun, (count - i) / kGroup) * kGroup;
    std::size_t listed = 0;
    for (; i < end; i += kGroup) listed = list(i, listed);
    for (std::size_t g = 0; g < listed; ++g) kept += store_group(kept_of[g], at[g], out + kept);
  }
  return i < count ? some(i, count, kept) : kept;
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
  const auto& p = frustum.planes;
  const F f;
  const WidePlane p0 = spread(f, p[0]), p1 = spread(f, p[1]), p2 = spread(f, p[2]), p3 = spread(f, p[3]),
                  p4 = spread(f, p[4]), p5 = spread(f, p[5]);
  const Nearest n0(p[0], boxes), n1(p[1], boxes), n2(p[2], boxes), n3(p[3], boxes), n4(p[4], boxes),
      n5(p[5], boxes);
  const auto from = [](const auto& at, const WidePlane& plane, const Nearest& n) HWY_ATTR {
    return distance(plane, {at(n.x), at(n.y), at(n.z)});
  };
  return pack(
      boxes.count, boxes.min_x, out, [](const auto&) HWY_ATTR { return hn::Zero(F()); },
      // Left and right reject what lies behind the eye, too.
      [&](const auto& at, VF than) HWY_ATTR { return lowest(than, from(at, p0, n0), from(at, p1, n1)); },
      [&](const auto& at, VF than) HWY_ATTR {
        return lowest(than, from(at, p2, n2), from(at, p3, n3), from(at, p4, n4), from(at, p5, n5));
      });
}

std::size_t cull_spheres(const Frustum& frustum, const SphereSpan& s, ObjectId* out) {
  const auto& p = frustum.planes;
  const F f;
  const WidePlane p0 = spread(f, p[0]), p1 = spread(f, p[1]), p2 = spread(f, p[2]), p3 = spread(f, p[3]),
                  p4 = spread(f, p[4]), p5 = spread(f, p[5]);
  const auto centre = [&](const auto& at) HWY_ATTR { return Points{at(s.x), at(s.y), at(s.z)}; };
  return pack(
      s.count, s.x, out,
      [&](const auto& at)
          HWY_ATTR { return hn::Neg(hn::Mul(at(s.radius), hn::Set(F(), geometry::kRadiusGrowth))); },
      [&](const auto& at, VF than) HWY_ATTR {
        const Points c = centre(at);
        return lowest(than, distance(p0, c), distance(p1, c));
      },
      [&](const auto& at, VF than) HWY_ATTR {
        const Points c = centre(at);
        return lowest(than, distance(p2, c), distance(p3, c), distance(p4, c), distance(p5, c));
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
  static_assert(kCullPadding == 64, "as the sentence says");
  if (visible.size() < count + kCullPadding)
    return {StatusCode::buffer_too_small, "cull: expected room for 64 more indices than there are elements"};
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
