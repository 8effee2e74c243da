// The account by itself, against sequences of frames that mean it ill.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "library/world/account.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;
using world::Account;
using world::ObjectCost;
using world::Purse;

struct Frame {
  double cost, frustum_cost;
};

// What culling by frustum costs in a frame, what share of its allowance a try spends, and what of the frame
// it saves in return.
struct Move {
  double frustum_cost, spends, saves;
};

constexpr int kKinds = 6;

// Sequences of six kinds: steady ones that never pay; all at random; savings and then none; dear frames among
// frames of nothing; views that see nothing from a moment on; the allowance spent to the end whatever comes.
Move adversary(int kind, int frame, Random& random) {
  const auto size = [&] { return std::pow(10.0, double{random.between(-3, 9)}); };
  const auto share = [&] { return double{random.between(0, 1)}; };
  switch (kind) {
    case 0:
      return {1e6, 1, 0};
    case 1:
      return {size(), share(), share() < 0.3 ? share() : 0};
    case 2:
      return {1e6, 1, frame / 100 % 2 == 0 ? 0.9 : 0};
    case 3:
      return {frame % 64 == 63 ? 1e9 : 1e-3, 1, 0};
    case 4:
      return {frame < 130 ? 1e6 : 0, 1, frame < 60 ? 0.5 : 0};
    default:
      return {size(), 1, share() < 0.05 ? 0.99 : 0};
  }
}

std::vector<Frame> played(int kind, std::uint32_t seed, int frames) {
  Random random(seed);
  Account account;
  std::vector<Frame> out;
  for (int i = 0; i < frames; ++i) {
    const Move move = adversary(kind, i, random);
    double cost = move.frustum_cost;
    if (account.begins_try(move.frustum_cost)) {
      Purse purse(account.allowance(move.frustum_cost));
      const double spent = move.spends * purse.left();
      EXPECT_TRUE(purse.affords(spent));
      purse.pay(spent);
      cost += purse.spent() - move.saves * move.frustum_cost;
    }
    account.close_frame(cost, move.frustum_cost);
    out.push_back({cost, move.frustum_cost});
  }
  return out;
}

TEST(Account, HoldsInEveryBeginningAndEveryWindowWhateverTheFramesAre) {
  for (int kind = 0; kind < kKinds; ++kind) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      const std::vector<Frame> frames = played(kind, seed, 400);
      double cost = 0, frustum = 0;
      for (std::size_t i = 0; i < frames.size(); ++i) {
        cost += frames[i].cost, frustum += frames[i].frustum_cost;
        ASSERT_LE(cost, 1.02 * frustum) << kind << ", " << seed << ", frame " << i;
        ASSERT_LE(frames[i].cost, 1.05 * frames[i].frustum_cost) << kind << ", " << seed << ", frame " << i;
        double in_window = 0, by_frustum = 0;
        for (std::size_t k = i < 63 ? 0 : i - 63; k <= i; ++k)
          in_window += frames[k].cost, by_frustum += frames[k].frustum_cost;
        ASSERT_LE(in_window, 1.05 * by_frustum) << kind << ", " << seed << ", frame " << i;
      }
    }
  }
}

TEST(Account, SpendsWhatItMayAndNotMore) {
  // The first frame, before anything was saved; then what was saved pays for the most that a frame may cost.
  Account account;
  EXPECT_NEAR(account.allowance(1e6), 0.02e6, 100);
  account.close_frame(0.5e6, 1e6);
  EXPECT_NEAR(account.allowance(1e6), 0.05e6, 100);
  // Whatever was saved: a window may begin with the frame, and see nothing after it.
  for (int i = 0; i < 1000; ++i) account.close_frame(0.1e6, 1e6);
  EXPECT_LE(account.allowance(1e6), 0.05e6);
  EXPECT_EQ(account.allowance(0), 0);
}

TEST(Account, TriesMoreAndMoreSeldomWhereThatNeverPaysAndAtOnceWhereItDoes) {
  Account account;
  int tries = 0;
  for (int i = 0; i < 640; ++i) {
    const bool tried = account.begins_try(1e6);
    tries += tried;
    account.close_frame(tried ? 1.01e6 : 1e6, 1e6);
  }
  EXPECT_GE(tries, 640 / 32);
  EXPECT_LE(tries, 640 / 32 + 6);
  // What is in view grew a little, and grew a lot; then it shrank, and all waits the longest.
  while (account.begins_try(1e6)) account.close_frame(1.01e6, 1e6);
  EXPECT_FALSE(account.begins_try(4e6));
  EXPECT_TRUE(account.begins_try(9e6));
  account.close_frame(9.1e6, 9e6);
  int waited = 0;
  for (; !account.begins_try(1e6); ++waited) account.close_frame(1e6, 1e6);
  EXPECT_EQ(waited, 31);
  account.close_frame(0.9e6, 1e6);
  EXPECT_TRUE(account.begins_try(1e6));
}

// What is learned of frames that draw some hundreds to thousands of objects; -1: nothing.
template <class TimeOf>
double learned(const TimeOf& time_of) {
  Random random(4);
  ObjectCost cost;
  for (int frame = 0; frame < 600; ++frame) {
    const auto objects = static_cast<std::size_t>(random.between(300, 3000));
    cost.drew(objects);
    // The sum of twelve is nearly a normal distribution, of variance 1.
    double noise = -6;
    for (int i = 0; i < 12; ++i) noise += double{random.between(0, 1)};
    cost.took(time_of(static_cast<double>(objects), noise));
  }
  return cost.value(-1);
}

TEST(ObjectCost, IsTheSlopeOfTimesOverObjects) {
  EXPECT_NEAR(learned([](double objects, double) { return 3e6 + 3e3 * objects; }), 3e3, 1);
  EXPECT_NEAR(learned([](double objects, double noise) { return 3e6 + 3e3 * objects + 1e6 * noise; }), 3e3,
              1e3);
}

// The display's time, or that of what else keeps a device busy, makes no object free.
TEST(ObjectCost, IsNotLearnedOfFramesThatWaitForSomethingElse) {
  EXPECT_EQ(learned([](double, double) { return 16.667e6; }), -1);
  EXPECT_EQ(learned([](double objects, double) { return std::max(16.667e6, 3e6 + 3e3 * objects); }), -1);
  EXPECT_EQ(learned([](double, double noise) { return 12e6 + 1e4 * noise; }), -1);
  EXPECT_GT(learned([](double objects, double) { return std::max(8e6, 3e6 + 3e3 * objects); }), 1e3);
}

}  // namespace
}  // namespace sightline
