// Long lives of random worlds: objects come, move, go and are given columns, among culls of every kind,
// snapshots, streams and refusals, and whatever a world says is held against a model of it.
#include <gtest/gtest.h>

#include "support/random_shapes.hpp"
#include "world/lives/life.hpp"

namespace sightline {
namespace {

TEST(RandomLives, AreWhatTheirModelsSay) {
  test::for_random_scenes(40, [](scene::Random& random) {
    lives::Life life(random);
    life.live();
  });
}

}  // namespace
}  // namespace sightline
