// A small seeded generator whose numbers are the same on every platform (splitmix64, Steele et al. 2014).
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <sightline/types.hpp>

#include "library/geometry/elementary.hpp"

namespace sightline::scene {

class Random {
public:
  explicit Random(std::uint64_t seed) noexcept : state_(seed) {}

  std::uint64_t next() noexcept {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /// In [0, 1), 24 bits.
  float unit() noexcept { return static_cast<float>(next() >> 40) * 0x1p-24f; }
  float between(float low, float high) noexcept { return low + (high - low) * unit(); }
  /// In [0, count).
  std::uint32_t below(std::uint32_t count) noexcept {
    return static_cast<std::uint32_t>((next() >> 32) * count >> 32);
  }

  Vec3 inside(const Box& box) noexcept {
    const float x = between(box.min.x, box.max.x), y = between(box.min.y, box.max.y);
    return {x, y, between(box.min.z, box.max.z)};
  }

  /// Uniform on the unit sphere.
  Vec3 direction() noexcept {
    const float y = between(-1, 1), angle = between(0, 2 * std::numbers::pi_v<float>);
    const float r = std::sqrt(std::fmax(0.0f, 1 - y * y));
    return {r * portable::cos(angle), y, r * portable::sin(angle)};
  }

private:
  std::uint64_t state_;
};

}  // namespace sightline::scene
