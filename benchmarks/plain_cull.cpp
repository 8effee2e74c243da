#include "plain_cull.hpp"

#ifdef __AVX512F__
#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>
#endif

namespace sightline::benchmarks {

#ifdef __AVX512F__

namespace {

// Sixteen boxes at a time: planes in registers, one fused operation a term, packed in a register, as the
// packing store is microcoded on Zen 4. kOut: after how many planes it looks whether a box is left; 6 for
// never.
template <std::size_t kOut>
std::size_t cull_plainly(const Frustum& frustum, const Boxes& boxes, std::span<ObjectId> visible) noexcept {
  struct Wide {
    __m512 x, y, z, distance;
    const float *at_x, *at_y, *at_z;
  };
  const auto spread = [&](std::size_t p) {
    const Vec3& n = frustum.planes[p].normal;
    return Wide{_mm512_set1_ps(n.x),
                _mm512_set1_ps(n.y),
                _mm512_set1_ps(n.z),
                _mm512_set1_ps(frustum.planes[p].distance),
                n.x >= 0 ? boxes.max_x.data() : boxes.min_x.data(),
                n.y >= 0 ? boxes.max_y.data() : boxes.min_y.data(),
                n.z >= 0 ? boxes.max_z.data() : boxes.min_z.data()};
  };
  const std::array<Wide, 6> planes{spread(0), spread(1), spread(2), spread(3), spread(4), spread(5)};
  const __m512i steps = _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
  const std::size_t count = boxes.size();
  std::size_t kept = 0;
  const auto step = [&](std::size_t i, auto whole, __mmask16 left) {
    const auto test = [&](std::size_t p) {
      const Wide& w = planes[p];
      const auto load = [&](const float* from) {
        return whole ? _mm512_loadu_ps(from + i) : _mm512_maskz_loadu_ps(left, from + i);
      };
      const __m512 x = load(w.at_x), y = load(w.at_y), z = load(w.at_z);
      const __m512 d = _mm512_fmadd_ps(w.x, x, _mm512_fmadd_ps(w.y, y, _mm512_fmadd_ps(w.z, z, w.distance)));
      return _mm512_cmp_ps_mask(d, _mm512_setzero_ps(), _CMP_GE_OQ);
    };
    __mmask16 in = left;
    for (std::size_t p = 0; p < kOut && p < 6; ++p) in &= test(p);
    if (kOut < 6) {
      if (in == 0) return;
      for (std::size_t p = kOut; p < 6; ++p) in &= test(p);
    }
    const __m512i ids = _mm512_add_epi32(steps, _mm512_set1_epi32(static_cast<int>(i)));
    _mm512_storeu_si512(visible.data() + kept, _mm512_maskz_compress_epi32(in, ids));
    kept += static_cast<std::size_t>(std::popcount(static_cast<unsigned>(in)));
  };
  // Up to where a line of memory begins, whole lines, the rest.
  const std::size_t in_line = reinterpret_cast<std::uintptr_t>(boxes.min_x.data()) / sizeof(float) % 16;
  std::size_t i = std::min(count, (16 - in_line) % 16);
  step(0, std::false_type(), static_cast<__mmask16>((1u << i) - 1));
  for (; i + 16 <= count; i += 16) step(i, std::true_type(), 0xffff);
  step(i, std::false_type(), static_cast<__mmask16>((1u << (count - i)) - 1));
  return kept;
}

}  // namespace

std::span<const PlainLoop> plain_loops() noexcept {
  static const PlainLoop loops[] = {{"PlainLoop", cull_plainly<6>},
                                    {"PlainLoopOut1", cull_plainly<1>},
                                    {"PlainLoopOut2", cull_plainly<2>},
                                    {"PlainLoopOut4", cull_plainly<4>}};
  return loops;
}

#else

std::span<const PlainLoop> plain_loops() noexcept {
  return {};
}

#endif

}  // namespace sightline::benchmarks
