// What worlds and cullers refuse, changing nothing.
#include <sightline/occlusion.hpp>
#include <sightline/world.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "support/random_views.hpp"
#include "support/run_threads.hpp"

namespace sightline {
namespace {

using scene::Random;

TEST(WorldRefusals, FindsStaleHandlesOut) {
  World world;
  std::array<Handle, 2> first, second;
  const std::array<WorldBox, 2> boxes{WorldBox{{0, 0, 0}, {1, 1, 1}}, WorldBox{{2, 0, 0}, {3, 1, 1}}};
  ASSERT_TRUE(world.insert(boxes, first));
  ASSERT_TRUE(world.remove(first));
  ASSERT_TRUE(world.insert(boxes, second));
  EXPECT_TRUE(world.contains(second[0]));
  EXPECT_FALSE(world.contains(first[0]));
  const Status moved = world.move(first, boxes);
  EXPECT_EQ(moved.code(), StatusCode::stale_handle);
  EXPECT_EQ(moved.index(), 0u);
  EXPECT_FALSE(world.remove(first));
  EXPECT_FALSE(world.remove(std::array{second[0], second[0]}));
  EXPECT_TRUE(world.contains(second[0]));  // nothing changed
  EXPECT_EQ(world.size(), 2u);
  EXPECT_TRUE(world.remove(second));
}

// Memory is asked for ahead of the check, but not by an index that nobody has looked at.
TEST(WorldRefusals, FindsHandlesOutThatNameNothingFarBehindTheFirst) {
  World world;
  std::array<Handle, 100> handles;
  const std::vector<WorldBox> boxes(handles.size(), WorldBox{{0, 0, 0}, {1, 1, 1}});
  ASSERT_TRUE(world.insert(boxes, handles));
  handles[70] = {0x2f2f2f2f, 0x2f2f2f2f};
  const Status moved = world.move(handles, boxes);
  EXPECT_EQ(moved.code(), StatusCode::stale_handle);
  EXPECT_EQ(moved.index(), 70u);
  World empty;  // where no index is one
  EXPECT_EQ(empty.move(std::vector<Handle>(100, handles[70]), boxes).code(), StatusCode::stale_handle);
}

TEST(WorldRefusals, RefusesBadBoxesAndChangesNothing) {
  World world;
  std::array<Handle, 2> handles;
  const double nan = std::nan("");
  for (const WorldBox& bad : {WorldBox{{0, 0, 0}, {1, nan, 1}}, WorldBox{{2, 0, 0}, {1, 1, 1}},
                              WorldBox{{-2e11, 0, 0}, {1, 1, 1}}, WorldBox{{0, 0, 0}, {INFINITY, 1, 1}}}) {
    const std::array boxes{WorldBox{{0, 0, 0}, {1, 1, 1}}, bad};
    const Status refused = world.insert(boxes, handles);
    EXPECT_EQ(refused.code(), StatusCode::bad_box);
    EXPECT_EQ(refused.index(), 1u);
    EXPECT_EQ(world.size(), 0u);
  }
}

// Many are checked at once: what one of them is must show wherever it stands among the others, and wherever
// these begin within a cache line.
TEST(WorldRefusals, FindsTheOneBadBoxOfManyAndWhatIsWrongWithIt) {
  constexpr std::size_t kBoxes = 41, kLine = 16;  // floats
  using Corners = std::array<float, 6>;
  const Corners good{-1, -2, -3, -1, 2, 3};
  alignas(64) std::array<float, kLine + 6 * kBoxes> room{};
  std::array<Handle, kBoxes> handles;
  const auto fill = [&](std::size_t start, const Corners& corners) {
    for (std::size_t i = 0; i < 6 * kBoxes; ++i) room[start + i] = corners[i % 6];
  };
  const auto insert = [&](World& world, std::size_t start) {
    return world.insert(BoxView::min_max(&room[start], sizeof(Corners), kBoxes), handles);
  };
  const float over = 1.1e11f, nan = std::nanf("");
  World untouched;
  for (std::size_t start = 0; start < kLine; ++start) {
    fill(start, good);
    for (std::size_t i = 0; i < 6 * kBoxes; ++i) {
      const std::size_t side = i % 6;
      for (const float value : {nan, -nan, INFINITY, -INFINITY, over, -over, side < 3 ? 4.0f : -4.0f}) {
        room[start + i] = value;
        const Status status = insert(untouched, start);
        ASSERT_EQ(status.code(), StatusCode::bad_box) << start << ' ' << i << ' ' << value;
        ASSERT_EQ(status.index(), i / 6) << start << ' ' << value;
      }
      room[start + i] = good[side];
    }
    World world;
    EXPECT_TRUE(insert(world, start));
    fill(start, {0, 0, 0, -0.0f, -0.0f, -0.0f});
    EXPECT_TRUE(insert(world, start)) << "zeros are equal";
    fill(start, {-9e10f, 0, 0, 9e10f, 0, 0});
    EXPECT_TRUE(insert(world, start));
  }
  EXPECT_EQ(untouched.size(), 0u);
}

// The same of boxes in structs of the caller's.
template <class Number>
void expect_one_bad_box(bool centred) {
  struct Thing {
    Number name, first[3], second[3];
  };
  constexpr std::size_t kBoxes = 130;
  const auto nan = std::numeric_limits<Number>::quiet_NaN(), over = static_cast<Number>(1.1 * kWorldReach);
  World world;
  std::vector<Handle> handles(kBoxes);
  ASSERT_TRUE(world.insert(std::vector<Box>(kBoxes, {{0, 0, 0}, {1, 1, 1}}), handles));
  for (std::size_t at = 0; at < kBoxes; ++at) {
    for (std::size_t side = 0; side < 6; ++side) {
      const Number least = side < 3 ? (centred ? nan : Number{4}) : Number{-1};
      for (const Number value : {nan, over, least}) {
        std::vector<Thing> things(kBoxes, {0, {0, 0, 0}, {1, 1, 1}});
        (side < 3 ? things[at].first : things[at].second)[side % 3] = value;
        const Number *first = things[0].first, *second = things[0].second;
        const Status moved =
            world.move(handles, centred ? BoxView::centre_half(first, second, sizeof(Thing), kBoxes)
                                        : BoxView::min_max(first, second, sizeof(Thing), kBoxes));
        ASSERT_EQ(moved.code(), StatusCode::bad_box) << at << ' ' << side << ' ' << value;
        ASSERT_EQ(moved.index(), at);
      }
    }
  }
  for (const Handle handle : handles) EXPECT_EQ(world.box(handle), (WorldBox{{0, 0, 0}, {1, 1, 1}}));
}

TEST(WorldRefusals, FindsTheOneBadBoxOfEveryForm) {
  for (const bool centred : {false, true}) {
    expect_one_bad_box<float>(centred);
    expect_one_bad_box<double>(centred);
  }
}

// The same of handles, one after another or apart.
TEST(WorldRefusals, FindsTheOneStaleHandleOfMany) {
  constexpr std::size_t kObjects = 200;
  const std::vector<Box> boxes(kObjects, {{0, 0, 0}, {1, 1, 1}});
  World world;
  std::vector<Handle> handles(kObjects);
  ASSERT_TRUE(world.insert(boxes, handles));
  // Of one id a generation greater than the table of them holds.
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(world.remove(std::array{handles[20]}));
    ASSERT_TRUE(world.insert(std::span(boxes).first(1), std::span(handles).subspan(20, 1)));
    const std::array stale{Handle{handles[20].index, handles[20].generation - 1}};
    ASSERT_EQ(world.move(stale, std::span(boxes).first(1)).code(), StatusCode::stale_handle) << i;
    ASSERT_TRUE(world.move(handles, boxes)) << i;
  }
  struct Apart {
    Handle handle;
    std::uint32_t between;
  };
  for (const std::size_t every : {1, 3, 7}) {  // as ids that lie close together are looked up at once
    std::vector<Handle> listed;
    for (std::size_t i = 0; i < kObjects; i += every) listed.push_back(handles[i]);
    const std::span its = std::span(boxes).first(listed.size());
    ASSERT_TRUE(world.move(listed, its));
    for (std::size_t at = 0; at < listed.size(); ++at) {
      const auto [id, generation] = listed[at];
      for (const Handle& wrong : {Handle{id, generation + 1}, Handle{id, 255}, Handle{id, generation + 256},
                                  Handle{kObjects, 0}, Handle{}}) {
        std::vector<Handle> some = listed;
        some[at] = wrong;
        std::vector<Apart> apart;
        for (const Handle& handle : some) apart.push_back({handle, 7});
        for (const Strided<const Handle>& given :
             {Strided<const Handle>(some), {&apart[0].handle, apart.size(), sizeof(Apart)}}) {
          const Status status = world.move(given, its);
          EXPECT_EQ(status.code(), StatusCode::stale_handle)
              << at << ' ' << wrong.index << ' ' << wrong.generation;
          EXPECT_EQ(status.index(), at);
        }
      }
    }
  }
}

TEST(WorldRefusals, RefusesBadCalls) {
  World world;
  Culler culler;
  std::vector<ObjectId> visible(cull_capacity(world));
  std::vector<std::uint8_t> masks(visible.size());
  Random random(1);
  CullView view{.view = {test::random_view(random, {{-1, -1, -1}, {1, 1, 1}}), {}}};
  const auto refusal = [&](std::span<const CullView> views, CullOutput output,
                           const CullOptions& options = {}) {
    return culler.cull(world, views, options, output).error().code();
  };
  const std::span one(&view, 1);
  EXPECT_EQ(refusal({}, {visible}), StatusCode::bad_argument);
  EXPECT_EQ(refusal(std::vector(kMaxViews + 1, view), {visible}), StatusCode::bad_argument);
  EXPECT_EQ(refusal(one, {std::span(visible).first(1)}), StatusCode::buffer_too_small);
  EXPECT_EQ(refusal(one, {visible, std::span(masks).first(1)}), StatusCode::buffer_too_small);
  EXPECT_EQ(refusal(one, {visible}, {.jobs = {test::run_threads, nullptr, 65}}), StatusCode::bad_argument);
  EXPECT_EQ(refusal(one, {visible}, {.jobs = {test::run_threads, nullptr, 0}}), StatusCode::bad_argument);
  EXPECT_EQ(refusal(one, {visible, masks}), StatusCode::ok);
  view.min_area = NAN;
  EXPECT_EQ(refusal(one, {visible}), StatusCode::bad_argument);
  view.min_area = 0;
  view.view.origin.x = NAN;
  EXPECT_EQ(refusal(one, {visible}), StatusCode::bad_view);
  view.view = {};
  view.view.view.eye_to_clip.m[5] = 0;
  const std::array two{CullView{}, view};
  EXPECT_EQ(refusal(two, {visible}), StatusCode::bad_view);
  EXPECT_EQ(culler.cull(world, two, {}, {visible}).error().index(), 1u);
}

// A wall, and boxes of which it hides the half: with another view's buffer, or last frame's, it would hide
// more.
TEST(WorldRefusals, RefusesABufferOfAnotherView) {
  World world;
  std::vector<Box> boxes;
  for (int i = 0; i < 40; ++i) {
    const auto x = static_cast<float>(i - 20);
    boxes.push_back({{x, -1, -31}, {x + 0.5f, 1, -30}});
  }
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(boxes, handles));
  Camera camera;
  const WorldView then{*make_view(camera, 320, 180), {}};
  camera.eye.x = 25;
  const WorldView now{*make_view(camera, 320, 180), {}};
  OcclusionBuffer buffer;
  std::vector<ObjectId> visible(cull_capacity(world));
  Culler culler;
  const auto culled = [&](const WorldView& view) {
    const CullView with{.view = view, .occlusion = &buffer};
    return culler.cull(world, with, visible);
  };
  EXPECT_EQ(culled(then).error().code(), StatusCode::stale_buffer) << "never begun";
  ASSERT_TRUE(buffer.begin(then));
  ASSERT_TRUE(buffer.draw_boxes(std::array{Box{{-20, -5, -11}, {0, 5, -10}}}));
  const auto mine = culled(then);
  ASSERT_TRUE(mine);
  EXPECT_LT(mine->count, 25u);
  EXPECT_GT(mine->count, 10u);
  EXPECT_EQ(culled(now).error().code(), StatusCode::stale_buffer);
  WorldView elsewhere = then;
  elsewhere.origin.z = 1;
  EXPECT_EQ(culled(elsewhere).error().code(), StatusCode::stale_buffer);
  EXPECT_FALSE(buffer.begin({.view = {}, .origin = {NAN, 0, 0}}));
  EXPECT_TRUE(culled(then)) << "a refused begin() leaves the buffer as it was";
}

}  // namespace
}  // namespace sightline
