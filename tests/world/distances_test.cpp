// Who is seen by layers and distances: what a world without columns sees, and of that what brute force
// leaves.
#include <sightline/world.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "library/geometry/linear.hpp"
#include "library/world/world_state.hpp"
#include "support/cull.hpp"
#include "support/random_views.hpp"
#include "support/rounds.hpp"
#include "support/run_threads.hpp"
#include "support/solid_boxes.hpp"

namespace sightline {
namespace {

using scene::Random;

constexpr float kInfinite = std::numeric_limits<float>::infinity();

std::array<double, 3> eye_of(const WorldView& view) {
  const glm::dvec4 eye = glm::inverse(geometry::to_double(view.view.world_to_eye))[3];
  return {view.origin.x + eye.x, view.origin.y + eye.y, view.origin.z + eye.z};
}

double distance(const WorldView& view, const WorldBox& b) {
  const auto eye = eye_of(view);
  const double x = 0.5 * (b.min.x + b.max.x) - eye[0], y = 0.5 * (b.min.y + b.max.y) - eye[1],
               z = 0.5 * (b.min.z + b.max.z) - eye[2];
  return std::sqrt(x * x + y * y + z * z);
}

// How near a distance may come to a limit for nobody to know on which side it is.
bool is_near(double distance, double limit) {
  return std::fabs(distance - limit) < 1e-3 + 1e-6 * distance;
}

// Two worlds of the same history, one of which has columns.
class Twins {
public:
  Twins(std::uint32_t seed, bool layers, bool distances)
      : random_(seed), with_layers_(layers), with_distances_(distances), by_place_(seed % 2 == 0) {}

  void insert(std::size_t count) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(test::random_box(random_, kPlace));
    std::vector<Handle> handles(count), others(count);
    const Given given = columns_of(boxes);
    ObjectColumns columns;
    const bool at_once = random_.below(3) > 0;  // or none, or later
    if (with_layers_ && at_once) columns.layers = std::span<const std::uint32_t>(given.layers);
    if (with_distances_ && at_once) columns.distances = std::span<const DistanceRange>(given.distances);
    ASSERT_TRUE(world_.insert(BoxView(boxes), handles, columns));
    ASSERT_TRUE(plain_.insert(BoxView(boxes), others));
    ASSERT_EQ(handles, others);
    for (std::size_t i = 0; i < count; ++i) {
      note(handles[i], with_layers_ && at_once ? given.layers[i] : kAllLayers,
           with_distances_ && at_once ? given.distances[i] : DistanceRange{});
      standing_.push_back(handles[i]);
    }
  }

  void change_columns() {
    const std::vector<Handle> some = pick();
    std::vector<Box> boxes;
    for (const Handle handle : some) boxes.push_back(geometry::relative_box(world_.box(handle), {}));
    const Given given = columns_of(boxes);
    if (with_layers_) ASSERT_TRUE(world_.set_layers(some, std::span<const std::uint32_t>(given.layers)));
    if (with_distances_)
      ASSERT_TRUE(world_.set_distances(some, std::span<const DistanceRange>(given.distances)));
    for (std::size_t i = 0; i < some.size(); ++i)
      note(some[i], with_layers_ ? given.layers[i] : kAllLayers,
           with_distances_ ? given.distances[i] : DistanceRange{});
  }

  void move(float by) {
    const std::vector<Handle> some = pick();
    std::vector<Box> boxes;
    for (const Handle handle : some) {
      Box box = geometry::relative_box(world_.box(handle), {});
      const float x = random_.between(-by, by), z = random_.between(-by, by);
      box.min.x += x, box.max.x += x, box.min.z += z, box.max.z += z;
      boxes.push_back(box);
    }
    ASSERT_TRUE(world_.move(some, BoxView(boxes)));
    ASSERT_TRUE(plain_.move(some, BoxView(boxes)));
  }

  void remove() {
    std::vector<Handle> some = pick();
    some.resize(some.size() / 2);
    ASSERT_TRUE(world_.remove(some));
    ASSERT_TRUE(plain_.remove(some));
    std::erase_if(standing_, [&](Handle h) { return !world_.contains(h); });
  }

  void expect_right() {
    for (const world::Sector& sector : WorldAccess::state(world_).sectors) {
      if (!sector.map) continue;
      const Status sound = sector.map->check();
      ASSERT_TRUE(sound) << sound.message() << " " << sound.index();
    }
    for (const Handle h : standing_) {
      ASSERT_EQ(world_.layers(h), layers_[h.index]);
      ASSERT_EQ(world_.distances(h), distances_[h.index]);
    }
    const std::size_t count = 1 + random_.below(kMaxViews);
    std::vector<CullView> views, without;
    for (std::size_t v = 0; v < count; ++v) {
      CullView view{.view = {test::random_view(random_, kPlace), {}}};
      if (v > 0 && random_.below(3) == 0) view.view = views[0].view;  // the same camera, perhaps
      if (random_.below(4) > 0) view.layers = random_.below(16);
      if (random_.below(2) == 0) view.distance_scale = random_.between(0.3f, 3);
      if (random_.below(3) == 0) view.distance_view = random_.below(static_cast<std::uint32_t>(count));
      if (random_.below(6) == 0) view.min_area = random_.between(0.1f, 50);
      views.push_back(view);
      without.push_back({.view = view.view, .min_area = view.min_area});
    }
    compare(views, without);
  }

  std::size_t kept = 0, could = 0, unknown = 0;

private:
  static constexpr Box kPlace{{-300, -40, -300}, {300, 40, 300}};
  struct Given {
    std::vector<std::uint32_t> layers;
    std::vector<DistanceRange> distances;
  };

  // Of neighbours mostly the same, or each its own.
  Given columns_of(std::span<const Box> boxes) {
    Given out;
    for (const Box& box : boxes) {
      const bool own = !by_place_ || random_.below(60) == 0;
      out.layers.push_back(own ? random_.below(16) : box.min.x > 0 ? 3 : 12);
      DistanceRange range{0, box.min.z > 0 ? 200.0f : kInfinite};
      if (own) range.min = random_.below(2) * random_.between(0, 200);
      if (own) range.max = range.min + (random_.below(5) == 0 ? kInfinite : random_.between(0, 300));
      out.distances.push_back(range);
    }
    return out;
  }

  void note(Handle handle, std::uint32_t layers, const DistanceRange& distances) {
    if (handle.index >= layers_.size())
      layers_.resize(handle.index + 1u), distances_.resize(handle.index + 1u);
    layers_[handle.index] = layers, distances_[handle.index] = distances;
  }

  // Some who stand near one another in the list.
  std::vector<Handle> pick() {
    const std::size_t count = random_.below(static_cast<std::uint32_t>(standing_.size())) / 2,
                      first = random_.below(static_cast<std::uint32_t>(standing_.size() - count));
    return {standing_.begin() + static_cast<std::ptrdiff_t>(first),
            standing_.begin() + static_cast<std::ptrdiff_t>(first + count)};
  }

  // What brute force says of an object that a view sees otherwise: 1, 0, or -1 where nobody knows.
  int sees(const std::vector<CullView>& views, std::size_t v, ObjectId id) const {
    const CullView& view = views[v];
    if ((layers_[id] & view.layers) == 0) return 0;
    const WorldView& from = view.distance_view == kOwnView ? view.view : views[view.distance_view].view;
    const double d = distance(from, world_.box(world_.handle(id)));
    const double scale = view.distance_scale, min = scale * distances_[id].min,
                 max = scale * distances_[id].max;
    if ((min > 0 && is_near(d, min)) || is_near(d, max)) return -1;
    return d >= min && d < max;
  }

  void compare(const std::vector<CullView>& views, const std::vector<CullView>& without) {
    const CullOptions options{.jobs = {test::run_threads, nullptr, 1 + random_.below(3)}};
    std::vector<ObjectId> all(cull_capacity(world_, options)), ids(all.size());
    std::vector<std::uint8_t> all_masks(all.size()), masks(all.size());
    const std::size_t plain = test::cull(culler_, plain_, without, all, all_masks, options).count,
                      count = test::cull(culler_, world_, views, ids, masks, options).count;
    std::size_t at = 0;
    for (std::size_t i = 0; i < plain; ++i) {
      const std::uint8_t got = at < count && ids[at] == all[i] ? masks[at++] : std::uint8_t{0};
      could += static_cast<std::size_t>(std::popcount(all_masks[i]));
      kept += static_cast<std::size_t>(std::popcount(got));
      for (std::size_t v = 0; v < views.size(); ++v) {
        const int expected = all_masks[i] >> v & 1 ? sees(views, v, all[i]) : 0;
        unknown += expected < 0;
        if (expected >= 0) ASSERT_EQ(got >> v & 1, expected) << "object " << all[i] << " view " << v;
      }
    }
    ASSERT_EQ(at, count) << "in another order, or what no view sees";
    // The same without masks, and by each view alone.
    ASSERT_EQ(test::cull(culler_, world_, views, all, {}, options).count, count);
    ASSERT_TRUE(std::equal(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count), all.begin()));
    if (views[0].distance_view != kOwnView) return;
    std::size_t mine = 0;
    for (std::size_t i = 0; i < count; ++i) mine += masks[i] & 1;
    ASSERT_EQ(test::cull(culler_, world_, std::span(views).first(1), all).count, mine);
  }

  Random random_;
  bool with_layers_, with_distances_, by_place_;
  World world_, plain_;
  Culler culler_;
  std::vector<Handle> standing_;
  std::vector<std::uint32_t> layers_;
  std::vector<DistanceRange> distances_;
};

// Of 1,000 worlds each feature has a third alone, and they have a third together.
TEST(Distances, AndLayersLeaveWhatBruteForceLeaves) {
  std::size_t kept = 0, could = 0, unknown = 0;
  for (std::uint32_t seed = 0; seed < test::rounds(1000); ++seed) {
    Twins twins(seed, seed % 3 != 0, seed % 3 != 1);
    twins.insert(seed % 50 == 0 ? 2500 : 20 + seed % 400);
    for (int frame = 0; frame < 3; ++frame) {
      twins.change_columns();
      twins.move(frame == 1 ? 300.0f : 2.0f);
      twins.expect_right();
      twins.remove();
      twins.insert(50);
      twins.expect_right();
    }
    ASSERT_FALSE(testing::Test::HasFatalFailure()) << "seed " << seed;
    kept += twins.kept, could += twins.could, unknown += twins.unknown;
  }
  EXPECT_GT(kept, could / 10);
  EXPECT_LT(kept, could / 5 * 4);
  EXPECT_LT(unknown, could / 10000 + 10);
}

// Chunks whose objects have the same columns are taken or left without a look at any of them.
TEST(Distances, AreDecidedByWholeChunksWhereTheseAgree) {
  Random random(4);
  std::vector<Box> boxes;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 at = random.inside({{-1000, -5, -1000}, {1000, 5, 1000}});
    boxes.push_back({at, {at.x + 1, at.y + 1, at.z + 1}});
  }
  std::vector<Handle> handles(boxes.size());
  std::vector<DistanceRange> near(boxes.size(), {0, 100});
  const std::vector<std::uint32_t> layers(boxes.size(), 5);
  World world;
  ASSERT_TRUE(world.insert(BoxView(boxes), handles,
                           {.layers = std::span(layers), .distances = std::span<const DistanceRange>(near)}));
  Camera above;
  above.eye = {0, 2000, 0}, above.forward = {0, -1, 0}, above.up = {0, 0, -1};
  above.vertical_fov = 2, above.far_plane = 5000;
  CullView view{.view = {*make_view(above, 640, 640), {}}};
  Culler culler;
  std::vector<ObjectId> ids(cull_capacity(world));
  const auto cull = [&] { return test::cull(culler, world, {&view, 1}, ids); };
  EXPECT_EQ(cull().count, 0u);
  EXPECT_EQ(cull().tested, 0u);
  view.distance_scale = 50;
  EXPECT_EQ(cull().count, boxes.size());
  EXPECT_EQ(cull().tested, 0u);
  view.layers = 2;
  EXPECT_EQ(cull().count, 0u);
  EXPECT_EQ(cull().tested, 0u);
  // One that differs opens its own chunk alone.
  view.layers = kAllLayers;
  near[0].max = 1;
  ASSERT_TRUE(
      world.set_distances(std::span(handles).first(1), std::span<const DistanceRange>(near).first(1)));
  EXPECT_EQ(cull().count, boxes.size() - 1);
  EXPECT_GT(cull().tested, 0u);
  EXPECT_LT(cull().tested, 100u);
  // And no longer once it is gone.
  ASSERT_TRUE(world.remove(std::span(handles).first(1)));
  EXPECT_EQ(cull().count, boxes.size() - 1);
  EXPECT_EQ(cull().tested, 0u);
}

TEST(Distances, OneOfTwoTakesOverFromTheOtherAtOneNumber) {
  World world;
  const std::array boxes{Box{{-1, -1, -1}, {1, 1, 1}}, Box{{-1, -1, -1}, {1, 1, 1}}};
  const std::array ranges{DistanceRange{0, 40}, DistanceRange{40, kInfinite}};
  std::array<Handle, 2> handles;
  ASSERT_TRUE(world.insert(BoxView(boxes), handles, {.distances = std::span<const DistanceRange>(ranges)}));
  std::vector<ObjectId> ids(cull_capacity(world));
  Culler culler;
  for (int step = 0; step <= 4000; ++step) {
    const float z = 0.02f * static_cast<float>(step);
    const CullView view{.view = {*make_view(Camera{.eye = {0, 0, z}}, 640, 360), {}}};
    ASSERT_EQ(test::cull(culler, world, {&view, 1}, ids).count, 1u) << z;
    ASSERT_EQ(ids[0], z >= 40 ? 1u : 0u) << z;
  }
}

TEST(Distances, OfACascadeAreItsCameras) {
  World world;
  const std::array boxes{Box{{-1, -1, -21}, {1, 1, -19}}, Box{{-1, -1, -81}, {1, 1, -79}}};
  const std::array ranges{DistanceRange{0, 50}, DistanceRange{0, 50}};
  std::array<Handle, 2> handles;
  ASSERT_TRUE(world.insert(BoxView(boxes), handles, {.distances = std::span<const DistanceRange>(ranges)}));
  Camera sun;
  sun.eye = {0, 500, -50}, sun.forward = {0, -1, 0}, sun.up = {1, 0, 0};
  sun.orthographic_height = 200, sun.far_plane = 1000;
  std::array views{CullView{.view = {*make_view(Camera{}, 640, 360), {}}},
                   CullView{.view = {*make_view(sun, 512, 512), {}}}};
  Culler culler;
  std::vector<ObjectId> ids(cull_capacity(world));
  std::vector<std::uint8_t> masks(ids.size());
  ASSERT_EQ(test::cull(culler, world, views, ids, masks).count, 1u);
  EXPECT_EQ(masks[0], 1);  // 500 m below the sun's eye
  views[1].distance_view = 0;
  ASSERT_EQ(test::cull(culler, world, views, ids, masks).count, 1u);
  EXPECT_EQ(ids[0], 0u);
  EXPECT_EQ(masks[0], 3);
}

TEST(Distances, WhatIsTooFarToBeSeenHidesNothing) {
  const std::vector<Box> boxes{test::box_at({0, 1, -10}, {30, 30, 0.5f}),
                               test::box_at({0, 1, -40}, {5, 5, 1})};
  test::SolidBoxes scene(boxes);
  const std::array<DistanceRange, 1> near{DistanceRange{0, 20}};
  ASSERT_TRUE(scene.world.set_distances(std::span(scene.handles).first(1), std::span(near)));
  CullView view{.view = {test::looking({0, 1, 0}, {0, 0, -1}, 1280, 960), {}}};
  Culler culler;
  const auto seen = [&] { return test::cull_with(culler, scene.world, {&view, 1}, test::automatic(5e6f)); };
  ASSERT_EQ(seen().result.count, 1u);
  EXPECT_EQ(seen().ids[0], scene.handles[0].index);
  // The culler remembers that the wall was worth drawing.
  view.distance_scale = 0.4f;
  ASSERT_EQ(seen().result.count, 1u);
  EXPECT_EQ(seen().ids[0], scene.handles[1].index);
}

TEST(Distances, AreRefusedWhereTheyAreNoRanges) {
  World world;
  const std::array boxes{Box{{-1, -1, -1}, {1, 1, 1}}, Box{{-1, -1, -1}, {1, 1, 1}}};
  std::array<Handle, 2> handles;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const DistanceRange wrong :
       {DistanceRange{-1, 5}, DistanceRange{5, 4}, DistanceRange{nan, 5}, DistanceRange{0, nan}}) {
    const std::array ranges{DistanceRange{}, wrong};
    const Status refused =
        world.insert(BoxView(boxes), handles, {.distances = std::span<const DistanceRange>(ranges)});
    EXPECT_EQ(refused.code(), StatusCode::bad_argument);
    EXPECT_EQ(refused.index(), 1u);
    EXPECT_EQ(world.size(), 0u);
  }
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  const std::array<DistanceRange, 2> none{DistanceRange{5, 4}, DistanceRange{}};
  EXPECT_EQ(world.set_distances(handles, std::span<const DistanceRange>(none)).code(),
            StatusCode::bad_argument);
  EXPECT_EQ(world.set_distances(handles, std::span<const DistanceRange>(none).last(1)).code(),
            StatusCode::bad_argument);
  EXPECT_EQ(world.distances(handles[0]), DistanceRange{});
  EXPECT_EQ(world.distances({}), (DistanceRange{0, 0}));
  std::vector<ObjectId> ids(cull_capacity(world));
  CullView view{.view = {*make_view(Camera{.eye = {0, 0, 9}}, 64, 64), {}}};
  Culler culler;
  const auto code = [&] { return culler.cull(world, view, ids).error().code(); };
  for (const float scale : {0.0f, -1.0f, nan, kInfinite}) {
    view.distance_scale = scale;
    EXPECT_EQ(code(), StatusCode::bad_argument);
  }
  view.distance_scale = 1, view.distance_view = 1;
  EXPECT_EQ(code(), StatusCode::bad_argument);
}

}  // namespace
}  // namespace sightline
