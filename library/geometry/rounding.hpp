// Sums and conversions that surely lie on one side of the exact value.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sightline::geometry {

/// What a + b lacks after rounding (Knuth's TwoSum): exact, but where the sum overflows.
inline double sum_error(double a, double b, double sum) noexcept {
  const double b_part = sum - a;
  return (a - (sum - b_part)) + (b - b_part);
}

/// Never above the exact sum; exact where that is a double.
inline double sum_down(double a, double b) noexcept {
  const double sum = a + b;
  return sum_error(a, b, sum) < 0 ? std::nextafter(sum, -std::numeric_limits<double>::infinity()) : sum;
}
/// Never below the exact sum.
inline double sum_up(double a, double b) noexcept {
  const double sum = a + b;
  return sum_error(a, b, sum) > 0 ? std::nextafter(sum, std::numeric_limits<double>::infinity()) : sum;
}

/// The next float, of a finite one.
inline float next_below(float f) noexcept {
  const auto bits = std::bit_cast<std::int32_t>(f);
  return std::bit_cast<float>(f > 0 ? bits - 1 : f < 0 ? bits + 1 : std::int32_t(0x80000001u));
}
inline float next_above(float f) noexcept {
  return -next_below(-f);
}

/// The nearest float that is not above `x`, of anything within the floats' range.
inline float float_down(double x) noexcept {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) > x ? next_below(f) : f;
}
/// The nearest float that is not below `x`.
inline float float_up(double x) noexcept {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) < x ? next_above(f) : f;
}

}  // namespace sightline::geometry
