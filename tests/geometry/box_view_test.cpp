#include <sightline/box_view.hpp>
#include <sightline/boxes.hpp>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "library/geometry/box_reader.hpp"
#include "library/geometry/rounding.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;

// Every layout that a caller may have, of the same boxes; numbers need no alignment.
struct Thing {
  char name[3];
  float centre[3], half[3], min[3], max[3];
};
#pragma pack(push, 1)
struct PackedThing {
  char name[3];
  double centre[3], half[3], min[3], max[3];
};
#pragma pack(pop)

Thing thing_of(Random& random) {
  Thing out{};
  for (int a = 0; a < 3; ++a) {
    out.centre[a] = std::round(random.between(-1000, 1000)), out.half[a] = std::round(random.between(0, 9));
    out.min[a] = out.centre[a] - out.half[a], out.max[a] = out.centre[a] + out.half[a];
  }
  return out;
}

// Or five of six loads of flat culling would cross two lines, and take a third longer.
TEST(Boxes, BeginWithCacheLines) {
  Boxes boxes;
  for (int i = 0; i < 300; ++i) {
    boxes.push_back({});
    for (const Boxes::Array* array :
         {&boxes.min_x, &boxes.min_y, &boxes.min_z, &boxes.max_x, &boxes.max_y, &boxes.max_z})
      ASSERT_EQ(reinterpret_cast<std::uintptr_t>(array->data()) % 64, 0u);
  }
}

TEST(BoxView, ReadsEveryLayoutAlike) {
  Random random(1);
  std::vector<Thing> things;
  std::vector<PackedThing> packed;
  Boxes arrays;
  std::vector<Box> structs;
  std::vector<WorldBox> wide;
  for (int i = 0; i < 100; ++i) {
    const Thing t = things.emplace_back(thing_of(random));
    PackedThing& p = packed.emplace_back();
    for (int a = 0; a < 3; ++a)
      p.centre[a] = t.centre[a], p.half[a] = t.half[a], p.min[a] = t.min[a], p.max[a] = t.max[a];
    structs.push_back({{t.min[0], t.min[1], t.min[2]}, {t.max[0], t.max[1], t.max[2]}});
    wide.push_back({{t.min[0], t.min[1], t.min[2]}, {t.max[0], t.max[1], t.max[2]}});
    arrays.push_back(structs.back());
  }
  const std::size_t n = things.size();
  const PackedThing& p = packed[0];
  for (const BoxView& view :
       {BoxView(structs), BoxView(wide), arrays.view(),
        BoxView::centre_half(things[0].centre, things[0].half, sizeof(Thing), n),
        BoxView::min_max(things[0].min, things[0].max, sizeof(Thing), n),
        BoxView::min_max(things[0].min, sizeof(Thing), n),
        BoxView::centre_half(static_cast<const double*>(static_cast<const void*>(
                                 reinterpret_cast<const char*>(&p) + offsetof(PackedThing, centre))),
                             static_cast<const double*>(static_cast<const void*>(
                                 reinterpret_cast<const char*>(&p) + offsetof(PackedThing, half))),
                             sizeof(PackedThing), n)}) {
    ASSERT_TRUE(view.sound());
    ASSERT_EQ(view.size(), n);
    for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(view[i], wide[i]) << i;
    EXPECT_EQ(view.part(7, 5)[2], wide[9]);
    geometry::BoxBlock block;
    const geometry::BoxSpan laid_out = BoxReader::lay_out(view, 30, 60, {}, block);
    for (std::size_t i = 0; i < 60; ++i) {
      ASSERT_EQ(laid_out.min_x[i], structs[30 + i].min.x);
      ASSERT_EQ(laid_out.max_z[i], structs[30 + i].max.z);
    }
  }
}

// In long double, which has 11 bits more than the sums need.
TEST(BoxView, RoundsOutwardsOrInwardsAndByNoMoreThanItMust) {
  Random random(2);
  int inexact = 0;
  for (int i = 0; i < 200000; ++i) {
    const auto number = [&](float most) {
      return random.between(-1, 1) * std::exp(random.between(-40, most));
    };
    const float centre[3] = {number(20), number(20), number(20)};
    const float half[3] = {std::fabs(number(10)), std::fabs(number(10)), std::fabs(number(10))};
    const WorldPoint origin{i % 2 ? 1e9 * random.between(-1, 1) : 0, 0.1 * i, -3200};
    const BoxView view = BoxView::centre_half(centre, half, 12, 1, origin);
    const WorldBox out = view[0];
    WorldBox in;
    BoxReader::read(view, 0, 1, &in, false);
    const long double low = static_cast<long double>(origin.x) + centre[0] - half[0];
    const long double high = static_cast<long double>(origin.x) + centre[0] + half[0];
    ASSERT_LE(static_cast<long double>(out.min.x), low);
    ASSERT_GE(static_cast<long double>(out.max.x), high);
    ASSERT_GE(static_cast<long double>(in.min.x), low);
    ASSERT_LE(static_cast<long double>(in.max.x), high);
    const double ulp = 0x1p-51 * (std::fabs(origin.x) + std::fabs(double{centre[0]}) + double{half[0]});
    ASSERT_LE(out.max.x - in.max.x, ulp);
    inexact += out.max.x != in.max.x;
    const Box near = geometry::relative_box(out, origin), inner = geometry::inner_box(in, origin);
    ASSERT_LE(static_cast<long double>(near.min.x), static_cast<long double>(out.min.x) - origin.x);
    ASSERT_GE(static_cast<long double>(near.max.y), static_cast<long double>(out.max.y) - origin.y);
    ASSERT_GE(static_cast<long double>(inner.min.x), static_cast<long double>(in.min.x) - origin.x);
    ASSERT_LE(static_cast<long double>(inner.max.y), static_cast<long double>(in.max.y) - origin.y);
  }
  EXPECT_GT(inexact, 1000);
}

// Boxes of numbers of all sizes, as one form gives them.
template <class Number>
struct Given {
  std::vector<std::array<Number, 6>> numbers;
  bool centred;

  Given(Random& random, std::size_t count, bool of_centres) : numbers(count), centred(of_centres) {
    const auto number = [&](float most) {
      const Number n = random.between(-1, 1) * std::exp(random.between(-40, most));
      return sizeof(Number) == sizeof(double) ? n * (1 + static_cast<Number>(1e-12) * random.below(99)) : n;
    };
    for (auto& box : numbers) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Number at = number(20), size = std::fabs(number(10));
        box[axis] = at, box[axis + 3] = centred ? size : at + size;
      }
    }
  }
  [[nodiscard]] BoxView view(const WorldPoint& origin) const {
    const Number *a = numbers[0].data(), *b = a + 3;
    const std::size_t stride = sizeof numbers[0], count = numbers.size();
    if constexpr (sizeof(Number) == sizeof(float))
      return centred ? BoxView::centre_half(a, b, stride, count, origin)
                     : BoxView::min_max(a, b, stride, count, origin);
    else
      return centred ? BoxView::centre_half(a, b, stride, count) : BoxView::min_max(a, b, stride, count);
  }
};

Box box_of(const geometry::BoxSpan& b, std::size_t i) {
  return {{b.min_x[i], b.min_y[i], b.min_z[i]}, {b.max_x[i], b.max_y[i], b.max_z[i]}};
}

template <class Number>
void expect_laid_out_as_read(Random& random, const WorldPoint& from, const WorldPoint& to) {
  for (const bool centred : {false, true}) {
    for (std::size_t count = 1; count <= geometry::kBlock; count += 3) {
      const Given<Number> given(random, count + 2, centred);
      const BoxView view = given.view(from);
      geometry::BoxBlock block;
      const geometry::BoxSpan laid_out = BoxReader::lay_out(view, 2, count, to, block);
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(box_of(laid_out, i), geometry::relative_box(view[2 + i], to))
            << sizeof(Number) << ' ' << centred << ' ' << i << " of " << count;
    }
  }
}

TEST(BoxView, LaysEveryFormOutAsItReadsItForEverySimdTarget) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    Random random(3);
    for (const WorldPoint& to : {WorldPoint{}, WorldPoint{3200, -6400, 0}, WorldPoint{1e9, 0.1, -1e-9}}) {
      expect_laid_out_as_read<double>(random, {}, to);
      expect_laid_out_as_read<float>(random, {}, to);
      expect_laid_out_as_read<float>(random, {5e6, 0.3, -7}, to);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

// About one origin nothing is moved there and back: what is asked for is as small as floats can say.
TEST(BoxView, LaysCentresOutNoWiderThanItMust) {
  Random random(4);
  const Given<float> given(random, geometry::kBlock, true);
  const WorldPoint origin{1e9, 0.1, -3200};
  geometry::BoxBlock block;
  const geometry::BoxSpan laid_out =
      BoxReader::lay_out(given.view(origin), 0, geometry::kBlock, origin, block);
  for (std::size_t i = 0; i < geometry::kBlock; ++i) {
    const long double centre = given.numbers[i][0], half = given.numbers[i][3];
    ASSERT_LE(laid_out.min_x[i], centre - half);
    ASSERT_GE(laid_out.max_x[i], centre + half);
    ASSERT_GE(std::nextafter(laid_out.min_x[i], INFINITY), centre - half);
    ASSERT_LE(std::nextafter(laid_out.max_x[i], -INFINITY), centre + half);
  }
}

template <class Number>
void expect_sure_only_of_valid(Random& random) {
  const std::array<Number, 10> odd{0,
                                   -0.0,
                                   -1,
                                   std::numeric_limits<Number>::quiet_NaN(),
                                   std::numeric_limits<Number>::infinity(),
                                   -std::numeric_limits<Number>::infinity(),
                                   static_cast<Number>(kWorldReach),
                                   static_cast<Number>(-kWorldReach),
                                   static_cast<Number>(1.01 * kWorldReach),
                                   static_cast<Number>(-0.95 * kWorldReach)};
  for (const WorldPoint& origin : {WorldPoint{}, WorldPoint{0, kWorldReach, -5}, WorldPoint{NAN, 0, 0}}) {
    for (const bool centred : {false, true}) {
      for (int round = 0; round < 300; ++round) {
        Given<Number> given(random, 5, centred);
        const bool usual = round % 3 == 0;
        if (!usual) given.numbers[random.below(5)][random.below(6)] = odd[random.below(odd.size())];
        const BoxView view = given.view(origin);
        bool valid = true;
        for (std::size_t i = 0; i < view.size(); ++i) valid = valid && geometry::is_valid(view[i]);
        const bool sure = BoxReader::surely_valid(view, 0, view.size());
        ASSERT_LE(sure, valid) << sizeof(Number) << ' ' << centred << ' ' << round;
        if (usual && origin == WorldPoint{}) ASSERT_TRUE(sure);
      }
    }
  }
}

TEST(BoxView, IsSureOfNoBoxThatIsNotValid) {
  Random random(5);
  expect_sure_only_of_valid<float>(random);
  expect_sure_only_of_valid<double>(random);
}

// No box, rather than one turned inside out.
TEST(BoxView, LaysNoBoxOutOfANegativeHalfSize) {
  const std::array<float, 6> numbers{0, 0, 0, 1, -1, NAN};
  for (const WorldPoint& origin : {WorldPoint{}, WorldPoint{3200, 0, 0}}) {
    geometry::BoxBlock block;
    const Box box = box_of(
        BoxReader::lay_out(BoxView::centre_half(&numbers[0], &numbers[3], 24, 1), 0, 1, origin, block), 0);
    EXPECT_EQ(box.max.x - box.min.x, 2);
    for (const float none : {box.min.y, box.max.y, box.min.z, box.max.z}) EXPECT_TRUE(std::isnan(none));
  }
}

TEST(BoxView, FloatsNextToADouble) {
  for (const double x : {0.0, -0.0, 1e-50, -1e-50, 1.0, 0.1, -0.1, 3e38, 1e300, -1e300}) {
    EXPECT_LE(static_cast<double>(geometry::float_down(x)), x);
    EXPECT_GE(static_cast<double>(geometry::float_up(x)), x);
    EXPECT_LE(std::nextafter(geometry::float_down(x), INFINITY),
              std::nextafter(geometry::float_up(x), INFINITY));
  }
  EXPECT_EQ(geometry::float_down(0.5), 0.5f);
  EXPECT_EQ(geometry::float_up(0.5), 0.5f);
}

TEST(BoxView, KnowsWhatIsNotSound) {
  const float* none = nullptr;
  const std::array<float, 6> six{};
  EXPECT_TRUE(BoxView().sound());
  EXPECT_TRUE(BoxView::min_max(none, 0, 0).sound()) << "of nothing, nothing is read";
  EXPECT_FALSE(BoxView::min_max(none, 24, 1).sound());
  EXPECT_TRUE(BoxView::min_max(six.data(), 24, 1).sound());
  EXPECT_FALSE(BoxView::min_max(six.data(), 23, 1).sound());
  EXPECT_FALSE(BoxView::min_max(six.data(), 0, 1).sound());
  EXPECT_FALSE(BoxView::min_max(six.data(), 24, static_cast<std::size_t>(-1)).sound());
  EXPECT_TRUE(BoxView::centre_half(six.data(), six.data() + 3, 12, 1).sound());
  EXPECT_FALSE(BoxView::centre_half(six.data(), six.data() + 3, 11, 1).sound());
  EXPECT_FALSE(BoxView::centre_half(six.data(), none, 12, 1).sound());
  EXPECT_FALSE(BoxView::arrays(six.data(), six.data(), six.data(), none, six.data(), six.data(), 1).sound());
  EXPECT_FALSE(SphereView(six.data(), none, 16, 1).sound());
  EXPECT_FALSE(SphereView(six.data(), six.data(), 8, 1).sound());
  EXPECT_FALSE(Strided<const float>(none, 1).sound());
  EXPECT_FALSE(Strided<const float>(six.data(), 2, 3).sound());
  EXPECT_TRUE(Strided<const float>(six).sound());
  const float negative[3] = {-1, 1, 1};
  EXPECT_FALSE(geometry::is_valid(BoxView::centre_half(six.data(), negative, 12, 1)[0]));
}

}  // namespace
}  // namespace sightline
