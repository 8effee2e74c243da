#include "library/geometry/elementary.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

// How many units of a double's last place it is from what long double says.
double off(double ours, long double truth) {
  const double nearest = std::fabs(static_cast<double>(truth));
  const double unit = std::nextafter(nearest, std::numeric_limits<double>::infinity()) - nearest;
  return static_cast<double>(std::fabs(static_cast<long double>(ours) - truth)) / unit;
}

TEST(Elementary, AreRightToAFewUnitsOfTheLastPlace) {
  scene::Random random(1);
  double sine = 0, cosine = 0, tangent = 0, exponential = 0, logarithm = 0;
  for (int i = 0; i < 200000; ++i) {
    const double angle = random.between(-1, 1) * (i % 2 == 0 ? 7.0 : 1e6);
    sine = std::max(sine, off(portable::sin(angle), std::sin(static_cast<long double>(angle))));
    cosine = std::max(cosine, off(portable::cos(angle), std::cos(static_cast<long double>(angle))));
    tangent = std::max(tangent, off(portable::tan(angle), std::tan(static_cast<long double>(angle))));
    const double power = random.between(-700, 700) + random.unit();
    exponential = std::max(exponential, off(portable::exp(power), std::exp(static_cast<long double>(power))));
    const double number = i % 2 == 0 ? portable::exp(power) : 0.5 + 1.5 * random.unit();
    logarithm = std::max(logarithm, off(portable::log(number), std::log(static_cast<long double>(number))));
  }
  std::printf("off by %.2f, %.2f, %.2f, %.2f, %.2f units\n", sine, cosine, tangent, exponential, logarithm);
  EXPECT_LT(sine, 3);
  EXPECT_LT(cosine, 3);
  EXPECT_LT(tangent, 5);  // a quotient of both
  EXPECT_LT(exponential, 2);
  EXPECT_LT(logarithm, 2);
}

TEST(Elementary, KnowWhatIsSimple) {
  EXPECT_EQ(portable::sin(0.0), 0);
  EXPECT_EQ(portable::cos(0.0), 1);
  EXPECT_EQ(portable::exp(0.0), 1);
  EXPECT_EQ(portable::log(1.0), 0);
  EXPECT_EQ(portable::exp(portable::log(1.0f)), 1);
  EXPECT_EQ(portable::cbrt(27.0f), 3);
  EXPECT_EQ(portable::sin(0.5), -portable::sin(-0.5));
  EXPECT_LE(std::fabs(portable::sin(1e300)), 1);
  EXPECT_TRUE(std::isnan(portable::cos(std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace sightline
