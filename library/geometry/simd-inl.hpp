// What the SIMD kernels of all folders share, for every width. Included by files that foreach_target compiles
// again and again; D is a Highway tag of floats, V a vector of it. Nothing is fused: mul and add round apart,
// in the order of the scalar twins, so that every width gives the same bits.
#if defined(SIGHTLINE_GEOMETRY_SIMD_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_GEOMETRY_SIMD_INL
#undef SIGHTLINE_GEOMETRY_SIMD_INL
#else
#define SIGHTLINE_GEOMETRY_SIMD_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <sightline/frustum.hpp>
#include <sightline/types.hpp>

HWY_BEFORE_NAMESPACE();
namespace sightline::geometry::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A bit a lane, from the lowest; of at most 32 lanes.
template <class D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask) {
#if HWY_TARGET == HWY_WASM  // where Highway writes the lanes to memory and reads them one by one
  if constexpr (hn::MaxLanes(D()) == 4 && sizeof(hn::TFromD<D>) == 4) {
    (void)d;
    return static_cast<std::uint32_t>(wasm_i32x4_bitmask(static_cast<v128_t>(mask.raw)));
  }
#endif
#if defined(__GNUC__) && !defined(__clang__) && HWY_TARGET <= HWY_AVX3
  // g++ 12 spills such a number as the 16 bits of its mask, and reads 32 back: what is moved by hand has all.
  // It is of no use to a register of masks, so it is no slower.
  if constexpr (sizeof(mask.raw) <= 4) {
    (void)d;
    std::uint32_t moved;
    if constexpr (sizeof(mask.raw) == 1)
      __asm__("kmovb %1, %0" : "=r"(moved) : "k"(mask.raw));
    else if constexpr (sizeof(mask.raw) == 2)
      __asm__("kmovw %1, %0" : "=r"(moved) : "k"(mask.raw));
    else
      __asm__("kmovd %1, %0" : "=r"(moved) : "k"(mask.raw));
    return moved & static_cast<std::uint32_t>((std::uint64_t{1} << hn::Lanes(d)) - 1);
  }
#endif
  // Read back as wide as it is written, or else the read waits until the write has reached memory.
  constexpr std::size_t kLanes = hn::MaxLanes(D());
  using Wide = std::conditional_t<kLanes <= 16, std::uint16_t, std::uint32_t>;
  using Bits = std::conditional_t<kLanes <= 8, std::uint8_t, Wide>;
  std::uint8_t bytes[8];
  hn::StoreMaskBits(d, mask, bytes);
  Bits bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits & static_cast<std::uint32_t>((std::uint64_t{1} << hn::Lanes(d)) - 1);
}

// The other way round; bits beyond the last lane mean nothing.
template <class D>
HWY_INLINE hn::Mask<D> mask_of(D d, std::uint64_t bits) {
  std::uint8_t bytes[8];
  std::memcpy(bytes, &bits, sizeof bytes);
  if (hn::Lanes(d) < 8) bytes[0] &= (1u << hn::Lanes(d)) - 1;
  return hn::LoadMaskBits(d, bytes);
}

// packed(d, values, keep) and (d, values, bits): the values of the mask's lanes, one after another, and any
// behind them. By tables of our own where a processor has no such operation: of Highway's, g++ copies all to
// the stack whenever a number of them is read.
constexpr bool kPacksByTable =
    HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_NEON || HWY_TARGET == HWY_WASM;
#if HWY_TARGET == HWY_AVX2
// Four bits a lane: where it comes from.
inline constexpr std::array<std::uint32_t, 256> kPackedLanes = [] {
  std::array<std::uint32_t, 256> out{};
  for (std::uint32_t bits = 0; bits < 256; ++bits) {
    std::uint32_t to = 0;
    for (std::uint32_t lane = 0; lane < 8; ++lane)
      if (bits >> lane & 1) out[bits] |= lane << 4 * to++;
  }
  return out;
}();

template <class D>
HWY_INLINE hn::Vec<D> packed(D d, hn::Vec<D> values, std::uint32_t bits) {
  static_assert(hn::MaxLanes(D()) == 8);
  const hn::RebindToUnsigned<D> u;
  alignas(32) static constexpr std::uint32_t kShift[8] = {0, 4, 8, 12, 16, 20, 24, 28};
  const auto from = hn::Shr(hn::Set(u, kPackedLanes[bits]), hn::Load(u, kShift));
  const __m256i out = _mm256_permutevar8x32_epi32(hn::BitCast(u, values).raw, from.raw);
  return hn::BitCast(d, hn::Vec<decltype(u)>{out});
}
#elif HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_NEON || HWY_TARGET == HWY_WASM
// A byte a byte: the same.
alignas(16) inline constexpr std::array<std::array<std::uint8_t, 16>, 16> kPackedBytes = [] {
  std::array<std::array<std::uint8_t, 16>, 16> out{};
  for (std::uint32_t bits = 0; bits < 16; ++bits) {
    std::uint32_t to = 0;
    for (std::uint32_t from = 0; from < 16; ++from)
      if (bits >> from / 4 & 1) out[bits][to++] = static_cast<std::uint8_t>(from);
  }
  return out;
}();

template <class D>
HWY_INLINE hn::Vec<D> packed(D d, hn::Vec<D> values, std::uint32_t bits) {
  static_assert(hn::MaxLanes(D()) == 4);
#if HWY_TARGET == HWY_WASM  // where Highway looks up byte by byte, with a branch each
  const v128_t from = wasm_v128_load(kPackedBytes[bits].data());
  (void)d;
  return hn::Vec<D>{wasm_i8x16_swizzle(static_cast<v128_t>(values.raw), from)};
#else
  const hn::Repartition<std::uint8_t, D> u8;
  return hn::BitCast(d,
                     hn::TableLookupBytes(hn::BitCast(u8, values), hn::Load(u8, kPackedBytes[bits].data())));
#endif
}
#else
template <class D>
HWY_INLINE hn::Vec<D> packed(D d, hn::Vec<D> values, std::uint32_t bits) {
  return hn::Compress(values, mask_of(d, bits));
}
#endif

template <class D>
HWY_INLINE hn::Vec<D> packed(D d, hn::Vec<D> values, hn::Mask<D> keep) {
  if constexpr (kPacksByTable) return packed(d, values, bits_of(d, keep));
  return hn::Compress(values, keep);
}

// Writes the values of the mask's lanes one after another and returns how many there are; a whole vector is
// written. Packed in a register first: the packing store is microcoded on some processors.
template <class D>
HWY_INLINE std::size_t store_kept(D d, hn::Vec<D> values, hn::Mask<D> keep, hn::TFromD<D>* HWY_RESTRICT out) {
  if constexpr (kPacksByTable) {
    const std::uint32_t bits = bits_of(d, keep);
    hn::StoreU(packed(d, values, bits), d, out);
    return static_cast<std::size_t>(std::popcount(bits));
  }
  hn::StoreU(hn::Compress(values, keep), d, out);
  return hn::CountTrue(d, keep);
}

// Lets `from` point at a vector of values each: where fewer than a vector's are left they are copied to
// `room`, the last one repeated, rather than read beyond.
template <std::size_t kArrays, class D>
HWY_INLINE void repeat_last(D d, std::size_t count, std::array<const float*, kArrays>& from,
                            std::array<std::array<float, 16>, kArrays>& room) {
  if (count >= hn::Lanes(d)) return;
  for (std::size_t a = 0; a < kArrays; ++a) {
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) room[a][i] = from[a][std::min(i, count - 1)];
    from[a] = room[a].data();
  }
}

// A vector of points, or of directions.
template <class V>
struct Points {
  V x, y, z;
};

template <class V>
HWY_INLINE V dot(const Points<V>& a, const Points<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class V>
HWY_INLINE V dot(const Points<V>& a, const std::array<float, 3>& b) {
  const hn::DFromV<V> d;
  return dot(a, Points<V>{hn::Set(d, b[0]), hn::Set(d, b[1]), hn::Set(d, b[2])});
}
template <class V>
HWY_INLINE Points<V> minus(const Points<V>& a, const Points<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Points<V> cross(const Points<V>& a, const Points<V>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
// The larger one, whatever the signs; no number where one of them is none, which processors' own comparisons
// drop or keep as each likes. Without signs, floats are in the order of their bits, and what is no number is
// last.
template <class V>
HWY_INLINE V larger_of(const V& a, const V& b) {
  const hn::DFromV<V> d;
  const hn::RebindToSigned<hn::DFromV<V>> bits;
  return hn::BitCast(d, hn::Max(hn::BitCast(bits, hn::Abs(a)), hn::BitCast(bits, hn::Abs(b))));
}
// The largest coordinate, likewise.
template <class V>
HWY_INLINE V largest(const Points<V>& p) {
  return larger_of(larger_of(p.x, p.y), p.z);
}
// a where it is less than b; b otherwise, so also where one of them is no number.
template <class V>
HWY_INLINE V lower_or(const V& a, const V& b) {
#if HWY_ARCH_X86
  return hn::Min(a, b);  // which is just that there, and one operation
#elif HWY_TARGET == HWY_WASM
  return V(wasm_f32x4_pmin(b.raw, a.raw));
#else
  return hn::IfThenElse(hn::Lt(a, b), a, b);
#endif
}

// A row of a matrix times (point, 1).
template <class V>
HWY_INLINE V dot_row(const Vec4& row, const Points<V>& p) {
  const hn::DFromV<V> d;
  return hn::Add(hn::Add(hn::Add(hn::Mul(hn::Set(d, row.x), p.x), hn::Mul(hn::Set(d, row.y), p.y)),
                         hn::Mul(hn::Set(d, row.z), p.z)),
                 hn::Set(d, row.w));
}
// signed_distance(), with its roundings.
template <class V>
HWY_INLINE V distance(const Plane& plane, const Points<V>& p) {
  return dot_row(Vec4{plane.normal.x, plane.normal.y, plane.normal.z, plane.distance}, p);
}

// A plane spread over the lanes, held in registers through a loop.
template <class V>
struct WidePlane {
  Points<V> normal;
  V distance;
};

template <class D>
HWY_INLINE WidePlane<hn::Vec<D>> spread(D d, const Plane& plane) {
  return {{hn::Set(d, plane.normal.x), hn::Set(d, plane.normal.y), hn::Set(d, plane.normal.z)},
          hn::Set(d, plane.distance)};
}

// signed_distance() of a vector of points, with its roundings.
template <class V>
HWY_INLINE V distance(const WidePlane<V>& plane, const Points<V>& p) {
  return hn::Add(dot(plane.normal, p), plane.distance);
}

// Less than `than` where some plane's distance to its point is: a distance that is no number takes no part.
// One comparison at the end then does for all planes, and minima go where products do not.
template <class V, class... Distances>
HWY_INLINE V lowest(V than, Distances... distances) {
  ((than = lower_or(distances, than)), ...);
  return than;
}

}  // namespace sightline::geometry::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
