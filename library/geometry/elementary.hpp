// sin, cos, tan, exp and log of our own, for generated worlds and views: every C library rounds its own way,
// and these use nothing but operations that IEEE 754 rounds alike everywhere. Series about 0 after the
// argument's reduction; wrong by at most three units in a double's last place, tan by five
// (tests/geometry/elementary_test.cpp), so a float of it is nearly always the nearest. Angles in radians;
// beyond 10⁶ they are taken modulo the double next to 2π.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace sightline::portable {

namespace detail {

// c[0] + x·(c[1] + x·(…)).
template <std::size_t N>
constexpr double polynomial(const std::array<double, N>& c, double x) noexcept {
  double sum = c[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = c[i] + x * sum;
  return sum;
}

// ±1/first!, ±1/(first + step)!, …, of alternating signs where `turn` is -1.
template <std::size_t N>
constexpr std::array<double, N> over_factorials(int first, int step, double turn) noexcept {
  std::array<double, N> out{};
  double factorial = 1, sign = 1;
  for (int i = 2; i <= first; ++i) factorial *= i;
  int n = first;
  for (double& c : out) {
    c = sign / factorial;
    for (int i = 0; i < step; ++i) factorial *= ++n;
    sign *= turn;
  }
  return out;
}

// 1/3, 1/5, 1/7, …
constexpr std::array<double, 10> over_odd() noexcept {
  std::array<double, 10> out{};
  double n = 3;
  for (double& c : out) c = 1 / n, n += 2;
  return out;
}

inline constexpr auto kSine = over_factorials<8>(3, 2, -1), kCosine = over_factorials<8>(4, 2, -1);
inline constexpr auto kExponential = over_factorials<13>(2, 1, 1);
inline constexpr auto kLogarithm = over_odd();

// An angle as a quarter turn's multiple and what is left, at most an eighth of a turn either way.
struct Turned {
  double rest;
  std::uint32_t quarters;  // modulo 4
};

// π/2 in three parts, of which the first two have 33 bits, so that their products with the multiple are exact
// (Cody & Waite 1980).
inline Turned turned(double angle) noexcept {
  constexpr double kHigh = 0x1.921fb544p+0, kMiddle = 0x1.0b4611a6p-34, kLow = 0x1.3198a2e037073p-69;
  if (!(std::fabs(angle) <= 1e6)) {
    angle = std::remainder(angle, 0x1.921fb54442d18p+2);
    if (std::isnan(angle)) return {angle, 0};
  }
  const double quarters = std::floor(angle * 0x1.45f306dc9c883p-1 + 0.5);
  const double rest = ((angle - quarters * kHigh) - quarters * kMiddle) - quarters * kLow;
  return {rest, static_cast<std::uint32_t>(static_cast<std::int64_t>(quarters) & 3)};
}

inline double sine_of(double x) noexcept {
  const double square = x * x;
  return x - x * square * polynomial(kSine, square);
}
inline double cosine_of(double x) noexcept {
  const double square = x * x;
  return 1 - square * (0.5 - square * polynomial(kCosine, square));
}

}  // namespace detail

inline double sin(double angle) noexcept {
  const detail::Turned t = detail::turned(angle);
  const double size = t.quarters % 2 == 0 ? detail::sine_of(t.rest) : detail::cosine_of(t.rest);
  return t.quarters < 2 ? size : -size;
}

inline double cos(double angle) noexcept {
  const detail::Turned t = detail::turned(angle);
  const double size = t.quarters % 2 == 0 ? detail::cosine_of(t.rest) : detail::sine_of(t.rest);
  return t.quarters == 1 || t.quarters == 2 ? -size : size;
}

inline double tan(double angle) noexcept {
  return sin(angle) / cos(angle);
}

/// Of -700 … 700.
inline double exp(double x) noexcept {
  constexpr double kHigh = 0x1.62e42feep-1, kLow = 0x1.a39ef35793c76p-33;  // ln 2
  const double twos = std::floor(x * 0x1.71547652b82fep+0 + 0.5);
  const double rest = (x - twos * kHigh) - twos * kLow;
  return std::ldexp(1 + (rest + rest * rest * detail::polynomial(detail::kExponential, rest)),
                    static_cast<int>(twos));
}

/// Of what is positive and finite.
inline double log(double x) noexcept {
  constexpr double kHigh = 0x1.62e42feep-1, kLow = 0x1.a39ef35793c76p-33;  // ln 2
  int twos = 0;
  double m = std::frexp(x, &twos);  // 1/2 … 1
  if (m < 0x1.6a09e667f3bcdp-1) m *= 2, --twos;
  // ln((1 + s)/(1 - s)) = 2·(s + s³/3 + s⁵/5 + …)
  const double over = m - 1, s = over / (2 + over), square = s * s;
  const double rest = 2 * s * square * detail::polynomial(detail::kLogarithm, square);
  return twos * kHigh + (2 * s + (rest + twos * kLow));
}

inline float sin(float angle) noexcept {
  return static_cast<float>(sin(double{angle}));
}
inline float cos(float angle) noexcept {
  return static_cast<float>(cos(double{angle}));
}
inline float tan(float angle) noexcept {
  return static_cast<float>(tan(double{angle}));
}
inline float exp(float x) noexcept {
  return static_cast<float>(exp(double{x}));
}
inline float log(float x) noexcept {
  return static_cast<float>(log(double{x}));
}
/// Of what is positive.
inline float cbrt(float x) noexcept {
  return static_cast<float>(exp(log(double{x}) / 3));
}

}  // namespace sightline::portable
