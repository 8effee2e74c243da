// Levels of detail: those of brute force in double precision, frame after frame.
#include <sightline/world.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "library/geometry/linear.hpp"
#include "support/cull.hpp"
#include "support/random_views.hpp"
#include "support/run_threads.hpp"
#include "support/solid_boxes.hpp"

namespace sightline {
namespace {

using geometry::to_double;
using scene::Random;

constexpr Box kField{{-300, -40, -300}, {300, 40, 300}};

double size_in(const WorldView& view, const WorldBox& b, double scale) {
  const auto& m = view.view.eye_to_clip.m;
  const glm::dvec4 eye = glm::inverse(to_double(view.view.world_to_eye))[3];
  const glm::dvec3 centre(0.5 * (b.min.x + b.max.x) - view.origin.x,
                          0.5 * (b.min.y + b.max.y) - view.origin.y,
                          0.5 * (b.min.z + b.max.z) - view.origin.z);
  const double radius =
      0.5 * glm::length(glm::dvec3(b.max.x - b.min.x, b.max.y - b.min.y, b.max.z - b.min.z));
  const double pixels =
      std::max(view.view.width * std::fabs(double{m[0]}), view.view.height * std::fabs(double{m[5]}));
  if (is_orthographic(view.view)) return scale * pixels * radius / std::fabs(double{m[15]});
  const double distance = glm::length(centre - glm::dvec3(eye));
  return distance <= radius ? 1e30 : scale * pixels * radius / (distance * std::fabs(double{m[11]}));
}

struct Known {
  std::uint32_t level = 0;
  int cull = -9;
};

// A world beside what brute force says of it, and remembers.
class Played {
public:
  explicit Played(std::uint32_t seed) : random_(seed) {
    const std::size_t count = seed % 50 == 0 ? 3000 : 30 + random_.below(300);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(test::random_box(random_, kField));
    handles_.resize(count);
    EXPECT_TRUE(world_.insert(BoxView(boxes), handles_));
    limits_.emplace_back();
    for (std::uint32_t t = 1 + random_.below(3); t > 0; --t) {
      std::vector<float> sizes;
      float size = random_.between(50, 600);
      for (std::uint32_t i = 1 + random_.below(7); i > 0; --i, size *= random_.between(0.2f, 0.9f))
        sizes.push_back(size);
      EXPECT_EQ(*world_.add_levels(sizes), limits_.size());
      limits_.push_back(sizes);
    }
    std::vector<LevelTableId> tables;
    for (std::size_t i = 0; i < count; ++i)
      tables.push_back(random_.below(static_cast<std::uint32_t>(limits_.size())));
    EXPECT_TRUE(world_.set_levels(handles_, std::span<const LevelTableId>(tables)));
  }

  void move() {
    const std::size_t some = handles_.size() / 3;
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < some; ++i) boxes.push_back(test::random_box(random_, kField));
    ASSERT_TRUE(world_.move(std::span(handles_).first(some), BoxView(boxes)));
  }

  // Some come, some go, whose ids are used again.
  void replace() {
    const std::size_t some = handles_.size() / 4;
    ASSERT_TRUE(world_.remove(std::span(handles_).first(some)));
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < some; ++i) boxes.push_back(test::random_box(random_, kField));
    ASSERT_TRUE(world_.insert(BoxView(boxes), std::span(handles_).first(some)));
    for (std::size_t i = 0; i < some; ++i) ASSERT_EQ(world_.levels(handles_[i]), kNoLevels);
  }

  // A camera that walks and looks about, by the same options in all frames.
  void walk(int frame) {
    if (frame == 0) {
      camera_ = test::random_camera(random_, kField);
      walked_.levels = {.hysteresis = random_.between(0, 0.3f), .fade = random_.below(2) * 0.3f};
    }
    const float step = random_.between(0, 3);
    camera_.eye.x += step, camera_.forward.y += random_.between(-0.05f, 0.05f);
    const Result<View> made = make_view(camera_, 1280, 720);
    const CullView view{.view = {made ? *made : *make_view({}, 1280, 720), {}}};
    std::vector<ObjectId> ids(cull_capacity(world_));
    std::vector<std::uint8_t> levels(ids.size()), fades(ids.size());
    const auto result = culler_.cull(world_, {&view, 1}, walked_, {ids, {}, levels, fades});
    ASSERT_TRUE(result);
    judge_all(std::span(ids).first(result->count), view.view, walked_.levels, levels, fades);
  }

  // Small steps, by which objects stay where they are filed.
  void nudge() {
    std::vector<Box> boxes;
    std::vector<Handle> some;
    for (const Handle handle : handles_) {
      if (random_.below(4) > 0) continue;
      const WorldBox b = world_.box(handle);
      const float by = random_.between(-3, 3);
      const auto at = [&](double x) { return static_cast<float>(x) + by; };
      boxes.push_back({{at(b.min.x), at(b.min.y), at(b.min.z)}, {at(b.max.x), at(b.max.y), at(b.max.z)}});
      some.push_back(handle);
    }
    ASSERT_TRUE(world_.move(some, BoxView(boxes)));
  }

  void change_tables() {
    std::vector<LevelTableId> tables;
    const std::size_t some = handles_.size() / 5;
    for (std::size_t i = 0; i < some; ++i)
      tables.push_back(random_.below(static_cast<std::uint32_t>(limits_.size())));
    ASSERT_TRUE(world_.set_levels(std::span(handles_).first(some), std::span<const LevelTableId>(tables)));
  }

  // A camera that goes on from frame to frame, and others.
  void cull(int frame) {
    if (frame == 0) camera_ = test::random_camera(random_, kField);
    camera_.eye.x += random_.between(-5, 5), camera_.eye.z += random_.between(-5, 5);
    const Result<View> made = make_view(camera_, 1280, 720);
    const WorldView camera{made ? *made : *make_view({}, 1280, 720), {}};
    std::vector<CullView> views{{.view = {test::random_view(random_, kField), {}}}, {.view = camera}};
    if (random_.below(2) == 0) views.push_back(views[0]);
    CullOptions options{.jobs = {test::run_threads, nullptr, 1 + random_.below(3)}};
    options.levels = {.view = 1, .key = random_.below(2)};
    if (random_.below(3) > 0) options.levels.hysteresis = random_.between(0, 0.4f);
    if (random_.below(2) == 0) options.levels.fade = random_.between(0, 1);
    if (random_.below(3) == 0) options.levels.scale = random_.between(0.3f, 3);
    options.levels.cut = random_.below(6) == 0;
    std::vector<ObjectId> ids(cull_capacity(world_, options)), plain(ids.size());
    std::vector<std::uint8_t> masks(random_.below(2) * ids.size()), levels(ids.size()),
        fades(random_.below(2) * ids.size());
    const auto result = culler_.cull(world_, views, options, {ids, masks, levels, fades});
    ASSERT_TRUE(result);
    Culler other;
    ASSERT_EQ(test::cull(other, world_, views, plain, {}, options).count, result->count);
    ASSERT_TRUE(
        std::equal(plain.begin(), plain.begin() + static_cast<std::ptrdiff_t>(result->count), ids.begin()));
    judge_all(std::span(ids).first(result->count), camera, options.levels, levels, fades);
  }

  std::size_t judged = 0, unknown = 0, held = 0;

private:
  void judge_all(std::span<const ObjectId> ids, const WorldView& view, const LevelOptions& options,
                 std::span<const std::uint8_t> levels, std::span<const std::uint8_t> fades) {
    auto& known = known_[options.key];
    const int now = ++culls_[options.key];
    for (std::size_t i = 0; i < ids.size(); ++i) {
      Known& k = known[ids[i]];
      const bool kept = k.cull == now - 1 && !options.cut;
      judge(ids[i], view, options, kept ? &k : nullptr, levels[i], fades.empty() ? nullptr : &fades[i]);
      k = {levels[i], now};
    }
  }

  void judge(ObjectId id, const WorldView& view, const LevelOptions& o, const Known* before,
             std::uint8_t level, const std::uint8_t* fade) {
    const Handle handle = world_.handle(id);
    const std::vector<float>& limits = limits_[world_.levels(handle)];
    const double size = size_in(view, world_.box(handle), o.scale);
    ++judged;
    for (const float limit : limits) {
      for (const double factor : {1.0, 1.0 + o.hysteresis, 1.0 - o.hysteresis})
        if (std::fabs(size - limit * factor) < 1e-4 * size) {
          ++unknown;
          return;
        }
    }
    std::uint32_t fresh = 0, expected = 0;
    while (fresh < limits.size() && size < limits[fresh]) ++fresh;
    expected = fresh;
    if (before) {
      expected = std::min(before->level, static_cast<std::uint32_t>(limits.size()));
      while (expected > 0 && size >= limits[expected - 1] * (1.0 + o.hysteresis)) --expected;
      while (expected < limits.size() && size < limits[expected] * (1.0 - o.hysteresis)) ++expected;
    }
    held += expected != fresh;
    ASSERT_EQ(level, expected) << "object " << id << " of size " << size;
    if (!fade) return;
    double share = 0;
    if (o.fade > 0 && level < limits.size()) {
      const double end = limits[level] * (1.0 + o.hysteresis);
      share = std::clamp((end * (1 + o.fade) - size) / (end * o.fade), 0.0, 1.0);
    }
    ASSERT_NEAR(*fade, 255 * share, 1.1 + 0.1 / std::max(o.fade, 1e-3f)) << "object " << id;
  }

  Random random_;
  World world_;
  Culler culler_;
  std::vector<Handle> handles_;
  std::vector<std::vector<float>> limits_;
  Camera camera_;
  CullOptions walked_;
  std::array<std::map<ObjectId, Known>, 2> known_;
  std::array<int, 2> culls_{};
};

TEST(Levels, AreThoseOfBruteForce) {
  std::size_t judged = 0, unknown = 0, held = 0;
  for (std::uint32_t seed = 0; seed < 1000; ++seed) {
    Played played(seed);
    for (int frame = 0; frame < 6; ++frame) {
      if (frame == 3) played.move();
      if (frame == 4) played.replace();
      played.cull(frame);
    }
    ASSERT_FALSE(testing::Test::HasFatalFailure()) << "seed " << seed;
    judged += played.judged, unknown += played.unknown, held += played.held;
  }
  EXPECT_GT(judged, 100000u);
  EXPECT_GT(held, judged / 200);
  EXPECT_LT(unknown, judged / 200);
}

// What is known to hold until the eye has gone some way must hold, and no longer where objects move.
TEST(Levels, OfAWalkAreThoseOfBruteForce) {
  std::size_t judged = 0, unknown = 0;
  for (std::uint32_t seed = 1000; seed < 1100; ++seed) {
    Played played(seed);
    for (int frame = 0; frame < 30; ++frame) {
      if (frame % 8 == 5) played.nudge();
      if (frame % 9 == 3) played.change_tables();
      if (frame == 20) played.move();
      if (frame == 23) played.replace();
      played.walk(frame);
    }
    ASSERT_FALSE(testing::Test::HasFatalFailure()) << "seed " << seed;
    judged += played.judged, unknown += played.unknown;
  }
  EXPECT_GT(judged, 50000u);
  EXPECT_LT(unknown, judged / 100);
}

// A box about the origin of 50 pixels' size some 43 m away, which has another level where it is smaller.
class OneBox {
public:
  OneBox() {
    const std::array boxes{Box{{-1, -1, -1}, {1, 1, 1}}};
    std::array<Handle, 1> handle;
    EXPECT_TRUE(world_.insert(BoxView(boxes), handle));
    const std::array sizes{50.0f};
    const std::array table{*world_.add_levels(sizes)};
    EXPECT_TRUE(world_.set_levels(handle, std::span<const LevelTableId>(table)));
    ids_.resize(cull_capacity(world_)), levels_.resize(ids_.size());
  }

  // From z metres before a place; of what is not seen there 255.
  std::uint32_t level(Culler& culler, float z, const LevelOptions& options, const WorldPoint& place = {}) {
    const CullView view{.view = {*make_view({.eye = {0, 0, z}}, 1280, 720), place}};
    const CullOptions all{.levels = options};
    return culler.cull(world_, {&view, 1}, all, {ids_, {}, levels_})->count == 1 ? levels_[0] : 255u;
  }

private:
  World world_;
  std::vector<ObjectId> ids_;
  std::vector<std::uint8_t> levels_;
};

// A camera that trembles at a limit.
TEST(Levels, DoNotFlickerWhereTheyAreHeld) {
  OneBox box;
  const auto changes = [&](float hysteresis) {
    Culler culler;
    std::size_t count = 0;
    std::uint32_t last = 0;
    for (int frame = 0; frame < 100; ++frame) {
      const std::uint32_t level =
          box.level(culler, 43.2f + (frame % 2 == 0 ? 0.5f : -0.5f), {.hysteresis = hysteresis});
      EXPECT_LE(level, 1u);
      const bool other = level != std::exchange(last, level);
      count += frame > 0 && other;
    }
    return count;
  };
  EXPECT_EQ(changes(0), 99u);
  EXPECT_LE(changes(0.1f), 1u);
}

// Culls are counted in 16 bits.
TEST(Levels, AreHeldForAnyNumberOfCulls) {
  OneBox box;
  Culler culler, fresh;
  const LevelOptions held{.hysteresis = 0.1f};
  ASSERT_EQ(box.level(fresh, 43.7f, held), 1u);
  ASSERT_EQ(box.level(culler, 40, held), 0u);
  for (int cull = 0; cull < 140'000; ++cull) ASSERT_EQ(box.level(culler, 43.7f, held), 0u) << cull;
}

// However far the eye has come, small steps change them.
TEST(Levels, FollowAnEyeThatHasComeFar) {
  OneBox box;
  Culler culler, fresh;
  for (int jump = 0; jump < 4000; ++jump)
    box.level(culler, 40, {.cut = true}, {jump % 2 == 0 ? 9e10 : 0.0, 0, 0});
  std::size_t changes = 0;
  std::uint32_t last = 0;
  for (float z = 40; z < 46; z += 0.005f) {
    const std::uint32_t level = box.level(culler, z, {});
    ASSERT_EQ(level, box.level(fresh, z, {.cut = true})) << z;
    changes += level != std::exchange(last, level);
  }
  EXPECT_EQ(changes, 1u);
}

// With occlusion in one call the objects that are left have the levels that they have without.
TEST(Levels, OfWhatAutomaticOcclusionLeavesAreTheSame) {
  Random random(4);
  std::vector<Box> boxes{test::box_at({0, 5, -10}, {30, 5, 0.5f})};
  for (int i = 0; i < 800; ++i)
    boxes.push_back(test::box_at({random.between(-60, 60), 1, random.between(-150, -15)}, {1, 1, 1}));
  test::SolidBoxes scene(std::move(boxes));
  const std::array sizes{100.0f, 40.0f, 15.0f};
  const std::vector<LevelTableId> tables(scene.boxes.size(), *scene.world.add_levels(sizes));
  ASSERT_TRUE(scene.world.set_levels(scene.handles, std::span<const LevelTableId>(tables)));
  Culler culler, plain;
  CullOptions options = test::automatic(5e6f), without;
  options.levels.hysteresis = without.levels.hysteresis = 0.2f;
  std::vector<ObjectId> ids(cull_capacity(scene.world));
  std::vector<std::uint8_t> levels(ids.size());
  std::size_t hidden = 0;
  for (int frame = 0; frame < 30; ++frame) {
    const Vec3 eye{0, 2, 0.2f * static_cast<float>(frame)};
    const CullView view{.view = {test::looking(eye, {0, 0, -1}, 1280, 960), {}}};
    std::map<ObjectId, std::uint8_t> expected;
    const std::size_t all = plain.cull(scene.world, {&view, 1}, without, {ids, {}, levels})->count;
    for (std::size_t i = 0; i < all; ++i) expected[ids[i]] = levels[i];
    const std::size_t count = culler.cull(scene.world, {&view, 1}, options, {ids, {}, levels})->count;
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(levels[i], expected[ids[i]]) << frame;
    hidden += all - count;
  }
  EXPECT_GT(hidden, 1000u);
}

TEST(Levels, AreRefusedWhereTheyMeanNothing) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(),
                  kInfinite = std::numeric_limits<float>::infinity();
  World world;
  const std::array boxes{Box{{-1, -1, -1}, {1, 1, 1}}};
  std::array<Handle, 1> handle;
  ASSERT_TRUE(world.insert(BoxView(boxes), handle));
  const auto code = [&](std::vector<float> sizes) { return world.add_levels(sizes).error().code(); };
  for (const auto& wrong : std::vector<std::vector<float>>{
           {}, {5, 5}, {5, 6}, {0}, {-1}, {kNaN}, {kInfinite}, {8, 7, 6, 5, 4, 3, 2, 1}})
    EXPECT_EQ(code(wrong), StatusCode::bad_argument);
  std::array<LevelTableId, 1> table{1};
  const std::span<const LevelTableId> tables(table);
  EXPECT_EQ(world.set_levels(handle, tables).code(), StatusCode::bad_argument);
  std::vector<ObjectId> ids(cull_capacity(world));
  std::vector<std::uint8_t> levels(ids.size(), 9), fades(ids.size(), 9);
  const CullView view{.view = {*make_view({.eye = {0, 0, 500}}, 64, 64), {}}};
  Culler culler;
  CullOptions options;
  const auto cull = [&] { return culler.cull(world, {&view, 1}, options, {ids, {}, levels, fades}); };
  // Without tables all have level 0.
  ASSERT_EQ(cull()->count, 1u);
  EXPECT_EQ(levels[0], 0);
  EXPECT_EQ(fades[0], 0);
  // Nor is too little room taken then, or a fade that no level says the meaning of.
  levels.clear();
  EXPECT_EQ(cull().error().code(), StatusCode::bad_argument);
  EXPECT_STREQ(cull().error().message(), "cull: fades without levels, expected both or no fades");
  levels.resize(ids.size() - 1);
  EXPECT_EQ(cull().error().code(), StatusCode::buffer_too_small);
  levels.resize(ids.size()), fades.resize(ids.size() - 1);
  EXPECT_EQ(cull().error().code(), StatusCode::buffer_too_small);
  fades.resize(ids.size());
  EXPECT_EQ(code({5}), StatusCode::ok);
  ASSERT_TRUE(world.set_levels(handle, tables));
  EXPECT_EQ(world.set_levels(handle, tables.first(0)).code(), StatusCode::bad_argument);
  EXPECT_STREQ(world.set_levels(handle, {table.data(), 1, 0}).message(),
               "world: the tables' pointer is null or their stride too short");
  EXPECT_EQ(world.levels(handle[0]), 1u);
  EXPECT_EQ(world.levels({}), kNoLevels);
  table[0] = 2;
  EXPECT_EQ(world.set_levels(handle, tables).index(), 0u);
  ASSERT_EQ(cull()->count, 1u);
  EXPECT_EQ(levels[0], 1);
  const LevelOptions wrong[] = {{.view = 1},           {.key = 8},           {.hysteresis = 1},
                                {.hysteresis = -0.1f}, {.hysteresis = kNaN}, {.fade = -1},
                                {.fade = kInfinite},   {.scale = 0},         {.scale = kNaN}};
  for (const LevelOptions& l : wrong) {
    options.levels = l;
    EXPECT_EQ(cull().error().code(), StatusCode::bad_argument);
  }
  options.levels = {};
  std::array<Handle, 1> second;
  ASSERT_TRUE(world.insert(BoxView(boxes), second));
  ids.resize(cull_capacity(world)), levels.resize(1), fades.resize(ids.size());
  EXPECT_EQ(cull().error().code(), StatusCode::buffer_too_small);
  levels.resize(ids.size()), fades.resize(1);
  EXPECT_EQ(cull().error().code(), StatusCode::buffer_too_small);
  levels.clear();
  EXPECT_EQ(cull().error().code(), StatusCode::buffer_too_small);
  fades.resize(ids.size());
  EXPECT_EQ(cull().error().code(), StatusCode::bad_argument);
}

// A refused cull is none: by none does a frame begin in which what moved comes to rest.
TEST(Levels, ThatAreRefusedChangeNothing) {
  const auto order_after = [](bool refused) {
    World world;
    std::vector<Box> boxes;
    for (int i = 0; i < 3000; ++i) {
      const auto x = static_cast<float>(i % 60), z = static_cast<float>(i / 60);
      boxes.push_back({{x, 0, z}, {x + 1, 1, z + 1}});
    }
    std::vector<Handle> handles(boxes.size());
    EXPECT_TRUE(world.insert(BoxView(boxes), handles));
    EXPECT_TRUE(world.add_levels(std::array{5.0f}));
    std::vector<ObjectId> ids(cull_capacity(world));
    std::vector<std::uint8_t> levels(ids.size());
    const CullView view{
        .view = {*make_view({.eye = {30, 500, 30}, .forward = {0, -1, 0}, .up = {0, 0, 1}}, 64, 64), {}}};
    Culler culler;
    EXPECT_TRUE(world.move(std::span(handles).first(1500), BoxView(std::span(boxes).first(1500))));
    CullOptions wrong;
    wrong.levels.hysteresis = 1;
    for (int frame = 0; frame < 300; ++frame) {
      if (refused) EXPECT_FALSE(culler.cull(world, {&view, 1}, wrong, {ids, {}, levels}));
      EXPECT_TRUE(world.move(Strided<const Handle>(), BoxView()));
    }
    ids.resize(culler.cull(world, view, ids)->count);
    return ids;
  };
  EXPECT_EQ(order_after(true), order_after(false));
}

}  // namespace
}  // namespace sightline
