// A world that was saved and loaded is the world that was saved, then and after.
#include <sightline/snapshot.hpp>

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "support/random_views.hpp"
#include "support/rounds.hpp"
#include "support/snapshots.hpp"
#include "support/world_twin.hpp"

namespace sightline {
namespace {

using scene::Random;

constexpr Box kPlace{{-5000, -60, -5000}, {5000, 60, 5000}};

// The same calls to several worlds; they must answer the same.
class Saved {
public:
  explicit Saved(std::uint32_t seed) : random_(seed) {
    for (std::uint32_t t = random_.below(3); t > 0; --t)
      tables_.push_back(*world.add_levels(std::vector<float>{300.0f + static_cast<float>(t), 40, 5}));
  }

  World world;
  std::map<ObjectId, WorldBox> twin;
  std::vector<Handle> handles;

  void insert(std::size_t count, World* other = nullptr) {
    std::vector<Box> boxes;
    while (boxes.size() < count) boxes.push_back(box());
    std::vector<Handle> added(count), theirs(count);
    ASSERT_TRUE(world.insert(BoxView(boxes), added));
    if (other) {
      ASSERT_TRUE(other->insert(BoxView(boxes), theirs));
      ASSERT_EQ(added, theirs);
    }
    handles.insert(handles.end(), added.begin(), added.end());
    note(added);
  }

  void move(std::size_t count, World* other = nullptr) {
    std::vector<Handle> moved;
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i)
      moved.push_back(handles[random_.below(static_cast<std::uint32_t>(handles.size()))]),
          boxes.push_back(box());
    ASSERT_TRUE(world.move(moved, BoxView(boxes)));
    if (other) ASSERT_TRUE(other->move(moved, BoxView(boxes)));
    note(moved);
  }

  void remove(std::size_t count, World* other = nullptr) {
    std::vector<Handle> gone;
    for (; count > 0 && handles.size() > 1; --count) {
      std::swap(handles[random_.below(static_cast<std::uint32_t>(handles.size()))], handles.back());
      gone.push_back(handles.back()), handles.pop_back();
      twin.erase(gone.back().index);
    }
    ASSERT_TRUE(world.remove(gone));
    if (other) ASSERT_TRUE(other->remove(gone));
    for (const Handle handle : gone) ASSERT_FALSE(world.contains(handle));
    stale.insert(stale.end(), gone.begin(), gone.end());
  }

  // Some of the columns.
  void set_columns() {
    std::vector<std::uint32_t> numbers, tables;
    std::vector<DistanceRange> distances;
    for (std::size_t i = 0; i < handles.size(); ++i) {
      numbers.push_back(random_.next());
      const float min = random_.below(2) * random_.between(0, 500);
      distances.push_back({min, min + random_.between(0, 9000)});
      tables.push_back(random_.below(static_cast<std::uint32_t>(tables_.size()) + 1));
    }
    if (random_.below(2)) ASSERT_TRUE(world.set_layers(handles, numbers));
    if (random_.below(2)) ASSERT_TRUE(world.set_values(handles, numbers));
    if (random_.below(2)) ASSERT_TRUE(world.set_distances(handles, distances));
    if (random_.below(2)) ASSERT_TRUE(world.set_levels(handles, tables));
  }

  std::vector<CullView> views() {
    std::vector<CullView> out;
    for (int v = 0; v < 3; ++v) {
      out.push_back({.view = {test::random_view(random_, kPlace), {}}});
      out.back().layers = random_.next();
      out.back().min_area = static_cast<float>(random_.below(2) * 4);
    }
    return out;
  }

  std::vector<Handle> stale;

private:
  Box box() {
    Box b = test::random_box(random_, kPlace);
    if (random_.below(30) == 0) b.min = b.max = {100, 5, 100};  // chunks of one point
    return b;
  }
  void note(std::span<const Handle> some) {
    for (const Handle handle : some) twin[handle.index] = world.box(handle);
  }

  Random random_;
  std::vector<LevelTableId> tables_;
};

void expect_like(Saved& played, World& loaded, bool in_order) {
  test::expect_sound(loaded);
  test::expect_same_objects(played.world, loaded);
  for (const Handle handle : played.stale) ASSERT_EQ(played.world.contains(handle), loaded.contains(handle));
  const std::vector<CullView> views = played.views();
  const test::Seen mine = test::seen(played.world, views), theirs = test::seen(loaded, views);
  ASSERT_EQ(test::sorted(mine), test::sorted(theirs));
  if (in_order) ASSERT_EQ(mine, theirs);
  Culler culler;
  std::vector<WorldView> plain;
  for (const CullView& view : views) plain.push_back(view.view);
  const auto& columns = WorldAccess::state(loaded).columns;
  if (!columns.any()) test::expect_right(loaded, culler, played.twin, plain, 0.05);
}

TEST(Snapshot, AWorldThatWasLoadedIsTheWorldThatWasSaved) {
  for (std::uint32_t seed = 0; seed < test::rounds(150); ++seed) {
    SCOPED_TRACE(seed);
    Saved played(seed);
    played.insert(seed % 10 == 0 ? 6000 : 20 + 7 * (seed % 60));
    if (seed % 3 > 0) played.set_columns();
    if (seed % 4 > 0) played.remove(played.handles.size() / 5);
    const bool moved = seed % 5 > 1;
    for (std::uint32_t i = 0; moved && i < 4; ++i) played.move(played.handles.size() / (1 + 5 * (seed % 4)));
    const test::FileBytes bytes = test::saved(played.world);
    Result<World> loaded = load(bytes);
    ASSERT_TRUE(loaded) << loaded.error().message();
    expect_like(played, *loaded, !moved);
    if (HasFatalFailure()) return;
    ASSERT_EQ(test::saved(*loaded), bytes);
    // And goes on as that does.
    for (int i = 0; i < 3; ++i) {
      played.move(played.handles.size() / 3, &*loaded);
      played.remove(played.handles.size() / 4, &*loaded);
      played.insert(30 + played.handles.size() / 4, &*loaded);
      expect_like(played, *loaded, false);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(Snapshot, AnEmptyWorldIsOneToo) {
  World empty;
  Result<World> loaded = load(test::saved(empty));
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->size(), 0u);
  EXPECT_EQ(WorldStream::open(test::saved(empty), empty)->size(), 0u);
}

TEST(Snapshot, FarSectorsAndHugeBoxesKeepTheirBits) {
  World world;
  const std::vector<WorldBox> boxes{{{9e10, -9e10, 9e10}, {9.1e10, -8e10, 9.9e10}},
                                    {{-1e11, -1e11, -1e11}, {1e11, 1e11, 1e11}},
                                    {{-1e11, 0, 0}, {-1e11, 0, 0}},
                                    {{1, 2, 3}, {1, 2, 3}}};
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(boxes, handles));
  const Result<World> loaded = load(test::saved(world));
  ASSERT_TRUE(loaded) << loaded.error().message();
  test::expect_same_objects(world, *loaded);
}

// Files are to be read by later versions: the format is pinned.
TEST(Snapshot, TheSameWorldGivesTheseBytes) {
  std::vector<Box> boxes;
  for (int i = 0; i < 500; ++i) {
    const auto x = static_cast<float>(i * 37 % 500 * 20), z = static_cast<float>(i * 101 % 500 * 8);
    boxes.push_back({{x, 0, z}, {x + 2, 4, z + 3}});
  }
  World world;
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  ASSERT_TRUE(world.remove(std::span<const Handle>(handles).first(50)));
  const test::FileBytes bytes = test::saved(world);
  EXPECT_EQ(bytes.size(), 15'696u);
  EXPECT_EQ(world::checksum(bytes), 595380209146910605u);
}

TEST(Snapshot, WhatCannotBeSavedIsRefused) {
  Saved played(1);
  played.insert(300);
  EXPECT_EQ(save(played.world, {}).code(), StatusCode::bad_argument);
  const SnapshotSink full{[](void*, std::span<const std::byte>) { return false; }, nullptr};
  EXPECT_EQ(save(played.world, full).code(), StatusCode::too_many);
  const test::FileBytes bytes = test::saved(played.world);
  EXPECT_EQ(WorldStream::open(bytes, played.world).error().code(), StatusCode::bad_argument);
  World streamed;
  ASSERT_TRUE(WorldStream::open(bytes, streamed));
  EXPECT_EQ(save(streamed, full).code(), StatusCode::bad_argument);
}

}  // namespace
}  // namespace sightline
