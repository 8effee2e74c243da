// Structs that grow: what the library makes of those of older and of newer headers.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "bindings/c/calls.hpp"

namespace {

using namespace sightline::c_api;

// A struct whose first version ended with `first`; `later` was added since.
struct Grown {
  std::uint32_t struct_size = sizeof(Grown);
  std::uint32_t first = 1;
  std::uint32_t later = 7;
};
constexpr std::size_t kFirstSize = SIGHTLINE_FIRST_SIZE(Grown, first);

std::array<std::uint32_t, 8> bytes_of(std::uint32_t struct_size) {
  return {struct_size, 5, 6, 0, 0, 0, 0, 0};
}

TEST(StructSize, OfAnOlderHeaderLeavesLaterMembersAsTheyAreByDefault) {
  Grown taken;
  ASSERT_TRUE(take_struct(bytes_of(kFirstSize).data(), kFirstSize, taken));
  EXPECT_EQ(taken.first, 5u);
  EXPECT_EQ(taken.later, 7u);
}

TEST(StructSize, OfTheSameHeaderIsTakenWhole) {
  Grown taken;
  ASSERT_TRUE(take_struct(bytes_of(sizeof(Grown)).data(), kFirstSize, taken));
  EXPECT_EQ(taken.first, 5u);
  EXPECT_EQ(taken.later, 6u);
}

TEST(StructSize, OfANewerHeaderOrOfNoneIsRefused) {
  const auto refused = [](std::uint32_t size) {
    Grown taken;
    return !take_struct(bytes_of(size).data(), kFirstSize, taken) && taken.first == 1 && taken.later == 7;
  };
  EXPECT_TRUE(refused(sizeof(Grown) + 4));
  EXPECT_TRUE(refused(kFirstSize - 1));
  EXPECT_TRUE(refused(0));
  EXPECT_TRUE(refused(0xffffffffu));
}

TEST(StructSize, CountsThatNoMemoryHoldsAreFound) {
  const double number = 0;
  EXPECT_TRUE(can_hold(&number, 1));
  EXPECT_TRUE(can_hold<double>(nullptr, 0));
  EXPECT_FALSE(can_hold<double>(nullptr, 1));
  EXPECT_FALSE(can_hold(&number, static_cast<std::size_t>(-1)));
  EXPECT_FALSE(can_hold(&number, kMostBytes / 8 + 1));
  EXPECT_TRUE(can_hold(&number, kMostBytes / 8));
  EXPECT_FALSE(can_hold(&number, kMostBytes / 8, 2));
  EXPECT_TRUE(can_hold(&number, kMostBytes / 16, 2));
}

}  // namespace
