// What fuzzers of the C API share.
#pragma once

#include <sightline/sightline.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "bytes.hpp"

namespace sightline::fuzz {

inline void require(bool holds) {
  if (!holds) __builtin_trap();
}

// One of them: a status that means something, and an index that is one.
inline bool done(sightline_status status) {
  require(status >= SIGHTLINE_OK && status <= SIGHTLINE_BAD_FILE);
  return status == SIGHTLINE_OK;
}

inline constexpr std::size_t kTooMuch = static_cast<std::size_t>(-1);

struct CallBytes : Bytes {
  using Bytes::Bytes;
  // Mostly sane, sometimes any bits at all.
  double number(double scale) {
    const std::uint8_t kind = byte();
    if (kind < 8) return take<double>();
    if (kind < 40) return scale * 1e6 * take<std::int8_t>();
    return scale * take<std::int16_t>() / 256.0;
  }
  float single(double scale) { return static_cast<float>(number(scale)); }
  bool rarely() { return byte() == 0; }
};

/// One to three alike, each with something of its own.
inline std::vector<sightline_cull_view> views_of(CallBytes& in, const sightline_view& view,
                                                 const sightline_occlusion* occlusion) {
  std::vector<sightline_cull_view> views(1 + in.byte() % 3, sightline_cull_view_of(&view));
  for (sightline_cull_view& v : views) {
    if (in.byte() & 1) v.layers = in.byte();
    if (in.byte() & 1) v.min_area = in.single(1);
    if (in.byte() < 64) v.occlusion = occlusion;
    if (in.byte() < 64) v.distance_view = in.byte() % 4u;
  }
  return views;
}

inline void run_here(void*, std::uint32_t count, void (*job)(void*, std::uint32_t), void* data) {
  for (std::uint32_t i = count; i-- > 0;) job(data, i);
}

template <class T, void (*destroy)(T*)>
struct Destroy {
  void operator()(T* object) const { destroy(object); }
};
template <class T, void (*destroy)(T*)>
using Owned = std::unique_ptr<T, Destroy<T, destroy>>;

}  // namespace sightline::fuzz
