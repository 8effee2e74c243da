// Vectors of large pages: what they hold when they grow.
#include "library/geometry/aligned_vector.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <utility>

namespace sightline {
namespace {

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
