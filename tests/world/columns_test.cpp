// Layers and values, and the caller's own structs.
#include <sightline/world.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/cull.hpp"
#include "support/random_views.hpp"
#include "support/run_threads.hpp"

namespace sightline {
namespace {

using scene::Random;

struct Thing {
  std::uint32_t layers;
  float position[3];
  float half[3];
  Handle handle;
  std::uint32_t value;
};

std::vector<Thing> random_things(Random& random, std::size_t count) {
  std::vector<Thing> out(count);
  for (Thing& t : out) {
    const Vec3 at = random.inside({{-200, -20, -200}, {200, 20, 200}});
    t = {1u << random.below(4),
         {at.x, at.y, at.z},
         {1, random.between(0, 3), 1},
         {},
         1000000 + random.below(1000)};
  }
  return out;
}

BoxView boxes_of(const std::vector<Thing>& things) {
  return BoxView::centre_half(things[0].position, things[0].half, sizeof(Thing), things.size());
}
Strided<Handle> handles_of(std::vector<Thing>& things) {
  return {&things[0].handle, things.size(), sizeof(Thing)};
}
Strided<const std::uint32_t> layers_of(const std::vector<Thing>& things) {
  return {&things[0].layers, things.size(), sizeof(Thing)};
}
Strided<const std::uint32_t> values_of(const std::vector<Thing>& things) {
  return {&things[0].value, things.size(), sizeof(Thing)};
}

TEST(Columns, AViewSeesItsLayersAlone) {
  Random random(1);
  std::vector<Thing> things = random_things(random, 5000);
  World plain, world;
  std::vector<Handle> handles(things.size());
  ASSERT_TRUE(plain.insert(boxes_of(things), handles));
  ASSERT_TRUE(world.insert(boxes_of(things), handles_of(things), {.layers = layers_of(things)}));
  Culler culler;
  const CullOptions threaded{.jobs = {test::run_threads, nullptr, 3}};
  std::size_t kept = 0, could = 0;
  for (int round = 0; round < 20; ++round) {
    const WorldView a{test::random_view(random, test::kAround), {}},
        b{test::random_view(random, test::kAround), {}};
    // The same view with other layers, another with all, one that sees no layer at all.
    const std::array<std::uint32_t, 4> layers{1, 6, kAllLayers, 0};
    const std::array views{CullView{.view = a, .layers = layers[0]}, CullView{.view = a, .layers = layers[1]},
                           CullView{.view = b, .layers = layers[2]},
                           CullView{.view = b, .layers = layers[3]}};
    std::vector<ObjectId> ids(cull_capacity(world, threaded)), without(ids.size());
    std::vector<std::uint8_t> masks(ids.size());
    const std::size_t all =
        test::cull(culler, plain, test::cull_views(std::array{a, a, b, b}), ids, masks, threaded).count;
    std::vector<std::pair<ObjectId, int>> expected;
    for (std::size_t i = 0; i < all; ++i) {
      int mask = masks[i];
      for (std::size_t v = 0; v < 4; ++v)
        if ((things[ids[i]].layers & layers[v]) == 0) mask &= ~(1 << v);
      if (mask != 0) expected.emplace_back(ids[i], mask);
    }
    const std::size_t count = test::cull(culler, world, views, ids, masks, threaded).count;
    std::vector<std::pair<ObjectId, int>> got;
    for (std::size_t i = 0; i < count; ++i) got.emplace_back(ids[i], masks[i]);
    EXPECT_EQ(got, expected);
    kept += got.size(), could += all;
    ASSERT_EQ(test::cull(culler, world, views, without, {}, threaded).count, count);
    EXPECT_TRUE(std::equal(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count), without.begin()));
  }
  EXPECT_GT(kept, 1000u);
  EXPECT_LT(kept, could);
}

TEST(Columns, ChangeAndAreForgottenWithTheirObject) {
  Random random(2);
  std::vector<Thing> things = random_things(random, 300);
  World world;
  ASSERT_TRUE(world.insert(boxes_of(things), handles_of(things),
                           {.layers = layers_of(things), .values = values_of(things)}));
  EXPECT_EQ(world.layers(things[5].handle), things[5].layers);
  EXPECT_EQ(world.value(things[5].handle), things[5].value);
  const std::array five{things[5].handle};
  ASSERT_TRUE(world.set_layers(five, std::array{64u}));
  ASSERT_TRUE(world.set_values(five, std::array{7u}));
  EXPECT_EQ(world.layers(five[0]), 64u);
  EXPECT_EQ(world.value(five[0]), 7u);
  // The id is used again, and has neither.
  ASSERT_TRUE(world.remove(five));
  EXPECT_EQ(world.layers(five[0]), 0u);
  std::array<Handle, 1> next;
  ASSERT_TRUE(world.insert(boxes_of(things).part(0, 1), next));
  EXPECT_EQ(next[0].index, five[0].index);
  EXPECT_EQ(world.layers(next[0]), kAllLayers);
  EXPECT_EQ(world.value(next[0]), next[0].index);
}

TEST(Columns, ValuesComeBackInsteadOfIds) {
  Random random(3);
  std::vector<Thing> things = random_things(random, 2000);
  World world;
  ASSERT_TRUE(world.insert(boxes_of(things), handles_of(things), {.values = values_of(things)}));
  Culler culler;
  const std::array view{CullView{.view = {*make_view(Camera{.eye = {0, 0, 150}}, 640, 360), {}}}};
  std::vector<std::uint32_t> ids(cull_capacity(world)), values(ids.size());
  const std::size_t count = test::cull(culler, world, view, ids).count;
  ASSERT_EQ(test::cull(culler, world, view, values, {}, {.values_for_ids = true}).count, count);
  EXPECT_GT(count, 50u);
  for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(values[i], things[ids[i]].value);
}

// Handles and boxes lie in the caller's structs; moving reads them there.
TEST(Columns, StructsOfTheCallersOwnMoveWhereTheyLie) {
  Random random(4);
  std::vector<Thing> things = random_things(random, 1000);
  World world;
  ASSERT_TRUE(world.insert(boxes_of(things), handles_of(things)));
  for (Thing& t : things) t.position[0] += 1;
  ASSERT_TRUE(world.move(handles_of(things), boxes_of(things)));
  for (std::size_t i = 0; i < things.size(); ++i) {
    const WorldBox stored = world.box(things[i].handle), given = boxes_of(things)[i];
    ASSERT_LE(stored.min.x, given.min.x);
    ASSERT_GE(stored.max.x, given.max.x);
    ASSERT_LE(given.min.x - stored.min.x, 2e-4);
  }
}

TEST(Columns, RefuseLengthsStridesAndPointersThatAreWrong) {
  Random random(5);
  std::vector<Thing> things = random_things(random, 10);
  World world;
  const float* none = nullptr;
  const auto code = [&](const BoxView& boxes, Strided<Handle> handles, const ObjectColumns& columns = {}) {
    const StatusCode out = world.insert(boxes, handles, columns).code();
    EXPECT_EQ(world.size(), 0u);
    EXPECT_EQ(world.id_limit(), 0u);
    return out;
  };
  const BoxView boxes = boxes_of(things);
  const Strided<Handle> handles = handles_of(things);
  EXPECT_EQ(code(boxes, Strided<Handle>(&things[0].handle, 9, sizeof(Thing))), StatusCode::bad_argument);
  EXPECT_EQ(code(boxes, Strided<Handle>(nullptr, 10)), StatusCode::bad_argument);
  EXPECT_EQ(code(boxes, Strided<Handle>(&things[0].handle, 10, 7)), StatusCode::bad_argument);
  EXPECT_EQ(code(BoxView::min_max(none, 24, 10), handles), StatusCode::bad_argument);
  EXPECT_EQ(code(BoxView::centre_half(things[0].position, things[0].half, 8, 10), handles),
            StatusCode::bad_argument);
  const auto most = static_cast<std::size_t>(-1);
  EXPECT_EQ(code(BoxView::centre_half(things[0].position, things[0].half, sizeof(Thing), most),
                 Strided<Handle>(&things[0].handle, most, sizeof(Thing))),
            StatusCode::bad_argument);
  EXPECT_EQ(code(boxes, handles, {.layers = {&things[0].layers, 9, sizeof(Thing)}}),
            StatusCode::bad_argument);
  EXPECT_EQ(code(boxes, handles, {.values = {&things[0].value, 10, 2}}), StatusCode::bad_argument);
  things[3].half[1] = -1;
  EXPECT_EQ(code(boxes, handles), StatusCode::bad_box);
  EXPECT_EQ(world.insert(boxes, handles).index(), 3u);
  things[3].half[1] = std::nanf("");
  EXPECT_EQ(code(boxes, handles), StatusCode::bad_box);
  things[3].half[1] = 1;
  ASSERT_TRUE(world.insert(boxes, handles));
  const std::array two{things[1].handle, Handle{77, 0}};
  EXPECT_EQ(world.set_layers(two, std::array{1u, 2u}).index(), 1u);
  EXPECT_EQ(world.set_layers(two, std::array{1u}).code(), StatusCode::stale_handle);
  EXPECT_EQ(world.set_values(std::array{things[1].handle}, std::array{1u, 2u}).code(),
            StatusCode::bad_argument);
  EXPECT_EQ(world.move(two, boxes.part(0, 2)).code(), StatusCode::stale_handle);
  EXPECT_EQ(world.move(two, boxes.part(0, 1)).code(), StatusCode::bad_argument);
}

}  // namespace
}  // namespace sightline
