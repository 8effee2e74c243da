// Vectors of large pages: what they hold when they grow.
#include "library/geometry/aligned_vector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace sightline {
namespace {

using geometry::AlignedVector;
using geometry::kLargePage;
using geometry::UnwrittenVector;

// From a few elements to several large pages, across where it is given pages of its own.
TEST(UnwrittenVector, KeepsItsElementsAsItGrows) {
  UnwrittenVector<std::uint32_t> values;
  EXPECT_TRUE(values.empty());
  std::uint32_t next = 0;
  for (std::size_t size = 1; size < 3 * kLargePage / sizeof(std::uint32_t); size = 2 * size + 7) {
    const std::size_t before = values.size();
    values.resize(size);
    ASSERT_EQ(values.size(), size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(values.data()) % 64, 0u);
    std::iota(values.begin() + before, values.end(), next);
    next += static_cast<std::uint32_t>(size - before);
    for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(values[i], i);
  }
}

// Whatever a heap left there before: subnormal numbers, with which all that reads beyond the last element
// would compute a hundred times as slowly.
TEST(UnwrittenVector, BeginsAsZeros) {
  for (const std::size_t size : {std::size_t{1000}, kLargePage}) {
    for (int block = 0; block < 2; ++block) {
      AlignedVector<std::uint32_t> used(size, 0x00007fffu);
      ASSERT_EQ(used.back(), 0x00007fffu);
    }
    UnwrittenVector<std::uint32_t> values(size / 2);
    EXPECT_TRUE(std::ranges::all_of(values, [](std::uint32_t v) { return v == 0; }));
    std::ranges::fill(values, 0x00007fffu);
    values.resize(size);
    EXPECT_TRUE(std::all_of(values.begin() + size / 2, values.end(), [](std::uint32_t v) { return v == 0; }));
  }
}

TEST(UnwrittenVector, MovesAndIsGivenUp) {
  UnwrittenVector<float> values(kLargePage);
  values[kLargePage - 1] = 3;
  UnwrittenVector<float> other(std::move(values));
  EXPECT_EQ(other.size(), kLargePage);
  values = std::move(other);
  EXPECT_EQ(values[kLargePage - 1], 3);
  other = UnwrittenVector<float>(5);
  other = std::exchange(values, {});
  EXPECT_TRUE(values.empty());
  EXPECT_EQ(other[kLargePage - 1], 3);
}

}  // namespace
}  // namespace sightline
