// How large objects are on an image, in SIMD.
#include "library/world/levels.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/world/level_sizes.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline::world::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void sizes_of_chunk(const ChunkMap::ChunkView& chunk, const Vec3& eye, bool orthographic, float squared_scale,
                    float* HWY_RESTRICT sizes) {
  const hn::CappedTag<float, 16> f;
  const auto half = hn::Set(f, 0.5f), scale = hn::Set(f, squared_scale), one = hn::Set(f, 1.0f);
  for (std::size_t i = 0; i < chunk.count; i += hn::Lanes(f)) {
    auto radius = hn::Zero(f), distance = hn::Zero(f);
    const auto add = [&](const float* low, const float* high, float at) HWY_ATTR {
      const auto a = hn::Mul(half, hn::Load(f, low + i)), b = hn::Mul(half, hn::Load(f, high + i));
      const auto extent = hn::Sub(b, a), offset = hn::Sub(hn::Add(a, b), hn::Set(f, at));
      radius = hn::Add(radius, hn::Mul(extent, extent));
      distance = hn::Add(distance, hn::Mul(offset, offset));
    };
    add(chunk.min_x, chunk.max_x, eye.x);
    add(chunk.min_y, chunk.max_y, eye.y);
    add(chunk.min_z, chunk.max_z, eye.z);
    const auto around = hn::Le(distance, radius);
    const auto size = hn::Sqrt(hn::Div(hn::Mul(scale, radius), orthographic ? one : distance));
    const auto infinite = hn::Set(f, std::numeric_limits<float>::infinity());
    hn::Store(orthographic ? size : hn::IfThenElse(around, infinite, size), f, sizes + i);
  }
}

}  // namespace sightline::world::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::world {
HWY_EXPORT(sizes_of_chunk);

void find_sizes(const ChunkMap::ChunkView& chunk, const Vec3& eye, bool orthographic, float squared_scale,
                float* sizes) noexcept {
  HWY_DYNAMIC_DISPATCH(sizes_of_chunk)(chunk, eye, orthographic, squared_scale, sizes);
}

}  // namespace sightline::world
#endif
