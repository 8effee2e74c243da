// What the passes over a world's groups share, for every SIMD width: bounds and boxes against planes.
// Included by files that foreach_target compiles again and again.
#if defined(SIGHTLINE_CULLING_WORLD_CULL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_CULLING_WORLD_CULL_INL
#undef SIGHTLINE_CULLING_WORLD_CULL_INL
#else
#define SIGHTLINE_CULLING_WORLD_CULL_INL
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <bit>
#include <cstring>

#include <sightline/culling.hpp>

#include "library/world/world_cull.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using world::ChunkMap;
using F = hn::CappedTag<float, 16>;
using U = hn::RebindToUnsigned<F>;
using VF = hn::Vec<F>;

constexpr std::size_t kGroup = ChunkMap::kGroupCapacity;

// signed_distance() of a vector of points: mul and add apart, in its order, so that it rounds alike.
HWY_INLINE VF distance(const Plane& plane, VF x, VF y, VF z) {
  const F f;
  const VF xy = hn::Add(hn::Mul(hn::Set(f, plane.normal.x), x), hn::Mul(hn::Set(f, plane.normal.y), y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(f, plane.normal.z), z)), hn::Set(f, plane.distance));
}

// A bit a lane, from the lowest.
HWY_INLINE std::uint32_t bits_of(hn::Mask<F> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(F(), mask, bytes);
  std::uint32_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits & ((1u << hn::Lanes(F())) - 1);
}

// What one view sees of a group's chunks, a bit a chunk.
struct ChunkBits {
  std::uint32_t kept = 0;                              // not outside
  std::uint32_t crossing = 0;                          // some plane
  std::array<std::uint32_t, Frustum::sides> planes{};  // crossing this one
};

// The bounds of a group's chunks or a node's groups, from the lane at which a bit 0 stands.
using Sides = std::array<const float*, 6>;

HWY_INLINE Sides sides_of(const ChunkMap::Group& group) {
  const auto& b = group.bounds;
  return {b[0].data(), b[1].data(), b[2].data(), b[3].data(), b[4].data(), b[5].data()};
}

// At most 32 boxes, readable up to the next multiple of 16.
HWY_INLINE ChunkBits classify_boxes(const Sides& sides, std::uint32_t count, const SectorView& view,
                                    PlaneSet planes) {
  const F f;
  const std::size_t lanes = hn::Lanes(f);
  const std::uint32_t all = count == 32 ? ~0u : (1u << count) - 1;
  std::uint32_t outside = 0;
  ChunkBits out;
  for (std::uint32_t rest = planes; rest != 0; rest &= rest - 1) {
    const int p = std::countr_zero(rest);
    const Plane& plane = view.frustum.planes[p];
    const auto &near = view.near_side[p], &far = view.far_side[p];
    for (std::size_t i = 0; i < count; i += lanes) {
      const VF high = distance(plane, hn::Load(f, sides[near[0]] + i), hn::Load(f, sides[near[1]] + i),
                               hn::Load(f, sides[near[2]] + i));
      const VF low = distance(plane, hn::Load(f, sides[far[0]] + i), hn::Load(f, sides[far[1]] + i),
                              hn::Load(f, sides[far[2]] + i));
      outside |= bits_of(hn::Lt(high, hn::Zero(f))) << i;
      out.planes[p] |= bits_of(hn::Lt(low, hn::Zero(f))) << i;
    }
    if ((all & ~outside) == 0) return {};
  }
  out.kept = all & ~outside;
  for (std::uint32_t& crossing : out.planes) out.crossing |= crossing &= out.kept;
  return out;
}

HWY_INLINE ChunkBits classify_chunks(const ChunkMap::Group& group, const SectorView& view, PlaneSet planes) {
  return classify_boxes(sides_of(group), group.count, view, planes);
}

// Those of the planes `among` that a chunk crosses.
HWY_INLINE PlaneSet planes_of(const ChunkBits& bits, std::uint32_t chunk, PlaneSet among = kAllPlanes) {
  PlaneSet planes = 0;
  for (std::uint32_t rest = among; rest != 0; rest &= rest - 1) {
    const int p = std::countr_zero(rest);
    planes |= static_cast<PlaneSet>((bits.planes[p] >> chunk & 1) << p);
  }
  return planes;
}

// Writes up to 63 values more than count, which kCullPadding leaves room for. Most chunks hold 48 to 96
// objects, evenly spread: one guess at whether there are more than 64 goes wrong less often than where a loop
// ends.
HWY_INLINE void copy_ids(const ObjectId* HWY_RESTRICT from, std::size_t count, ObjectId* HWY_RESTRICT to) {
  const U u;
  const auto copy = [&](std::size_t first, std::size_t end) HWY_ATTR {
    for (std::size_t i = first; i < end; i += hn::Lanes(u)) hn::StoreU(hn::Load(u, from + i), u, to + i);
  };
  if (count <= ChunkMap::kSmallCapacity) return copy(0, ChunkMap::kSmallCapacity);
  copy(0, 64);
  if (count > 64) copy(64, ChunkMap::kCapacity);
}

// The sides of boxes that lie farthest along a plane's normal, and the plane.
struct Corner {
  const float *x, *y, *z;
  const Plane* plane;
};

HWY_INLINE std::size_t corners_of(const ChunkMap::ChunkView& chunk, const SectorView& view, PlaneSet planes,
                                  Corner* out) {
  const auto step = static_cast<std::size_t>(chunk.min_y - chunk.min_x);
  std::size_t count = 0;
  for (std::uint32_t rest = planes; rest != 0; rest &= rest - 1) {
    const int p = std::countr_zero(rest);
    const auto& near = view.near_side[p];
    out[count++] = {chunk.min_x + step * near[0], chunk.min_x + step * near[1], chunk.min_x + step * near[2],
                    &view.frustum.planes[p]};
  }
  return count;
}

// Calls use(first, mask) for each vector of `count` objects: which of them the planes leave. The planes are
// held in registers where they are few, as they nearly always are.
template <std::size_t kPlanes, class Use>
HWY_INLINE void test_planes(const Corner* corners, std::size_t planes, std::size_t count, const Use& use) {
  const F f;
  std::array<Plane, kPlanes> plane;
  for (std::size_t c = 0; c < kPlanes; ++c) plane[c] = *corners[c].plane;
  for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
    const auto at = [&](std::size_t c, const Plane& p) HWY_ATTR {
      return distance(p, hn::Load(f, corners[c].x + i), hn::Load(f, corners[c].y + i),
                      hn::Load(f, corners[c].z + i));
    };
    VF worst = hn::Zero(f);
    for (std::size_t c = 0; c < kPlanes; ++c) worst = hn::Min(worst, at(c, plane[c]));
    for (std::size_t c = kPlanes; c < planes; ++c) worst = hn::Min(worst, at(c, *corners[c].plane));
    use(i, hn::Ge(worst, hn::Zero(f)));
  }
}

template <class Use>
HWY_INLINE void test_planes(const Corner* corners, std::size_t planes, std::size_t count, const Use& use) {
  if (planes == 1) return test_planes<1>(corners, 1, count, use);
  if (planes == 2) return test_planes<2>(corners, 2, count, use);
  test_planes<0>(corners, planes, count, use);
}

// A bit an object of a chunk. Whole words are kept in registers and stored once: loads that gather what
// several narrow stores have just written make processors wait.
struct alignas(16) ObjectBits {
  std::array<std::uint64_t, 2> words{};

  [[nodiscard]] bool at(std::size_t i) const { return words[i / 64] >> (i % 64) & 1; }
  void drop(std::size_t i) { words[i / 64] &= ~(std::uint64_t{1} << (i % 64)); }
};
static_assert(ChunkMap::kCapacity <= 128);

// Those of objects i … that a vector of D holds.
template <class D>
HWY_INLINE hn::Mask<D> mask_at(D d, const ObjectBits& bits, std::size_t i) {
  std::uint8_t from[8];
  if (hn::Lanes(d) < 8) {
    from[0] = static_cast<std::uint8_t>(bits.words[i / 64] >> (i % 64) & ((1u << hn::Lanes(d)) - 1));
  } else {
    std::memcpy(from, reinterpret_cast<const std::uint8_t*>(&bits.words) + i / 8, hn::Lanes(d) / 8);
  }
  return hn::LoadMaskBits(d, from);
}

HWY_INLINE void prefetch_ids(const ChunkMap::ChunkView& chunk) {
  // Boxes are read along their rows, which processors find out by themselves.
  for (std::uint32_t i = 0; i < 64; i += 16) hwy::Prefetch(chunk.objects + i);
  if (chunk.count <= 64) return;
  for (std::uint32_t i = 64; i < ChunkMap::kCapacity; i += 16) hwy::Prefetch(chunk.objects + i);
}

// Which objects the planes leave, and `also(i, mask)` of each vector of them; bits from count on mean
// nothing.
template <class Also>
HWY_INLINE ObjectBits test_objects(const ChunkMap::ChunkView& chunk, const Corner* corners,
                                   std::size_t planes, const Also& also) {
  ObjectBits out;
  std::uint64_t low = 0, high = 0;
  test_planes(corners, planes, chunk.count, [&](std::size_t i, hn::Mask<F> mask) HWY_ATTR {
    const std::uint64_t bits = bits_of(also(i, mask));
    if (i < 64) {
      low |= bits << i;
    } else {
      high |= bits << (i - 64);
    }
  });
  out.words = {low, high};
  return out;
}

// One view, frustum only: ids straight into `out`.
HWY_INLINE std::size_t cull_chunk(const ChunkMap::ChunkView& chunk, const Corner* corners, std::size_t planes,
                                  ObjectId* HWY_RESTRICT out) {
  const U u;
  std::size_t kept = 0;
  test_planes(corners, planes, chunk.count, [&](std::size_t i, hn::Mask<F> mask) HWY_ATTR {
    auto keep = hn::RebindMask(u, mask);
    if (i + hn::Lanes(u) > chunk.count) keep = hn::And(keep, hn::FirstN(u, chunk.count - i));
    // Packed in a register and stored whole: the packing store is microcoded on some processors.
    hn::StoreU(hn::Compress(hn::Load(u, chunk.objects + i), keep), u, out + kept);
    kept += hn::CountTrue(u, keep);
  });
  return kept;
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
