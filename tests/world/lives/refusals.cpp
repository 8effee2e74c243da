#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "world/lives/operations.hpp"

namespace sightline::lives {
namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

// Of an object that was removed, or that never was.
Handle stale_handle(Life& life, Handle handle) {
  Random& random = life.random;
  const std::vector<Handle>& gone = life.model.gone;
  if (!gone.empty() && one_in(random, 2)) return gone[below(random, gone.size())];
  if (one_in(random, 2)) return {handle.index, handle.generation + 1 + random.below(300)};
  const auto beyond = static_cast<std::uint32_t>(life.world().id_limit());
  return one_in(random, 2) ? Handle{} : Handle{beyond + random.below(50), random.below(3)};
}

// Right but for the object at one place in the list.
struct Attempt {
  std::vector<Handle> handles;
  std::vector<WorldBox> boxes;
  std::size_t at;

  Handle& handle() { return handles[at]; }
  WorldBox& box() { return boxes[at]; }
  template <class T>
  [[nodiscard]] std::vector<T> column(const T& bad) const {
    std::vector<T> out(handles.size());
    out[at] = bad;
    return out;
  }
};

struct Refusal {
  Status status;
  StatusCode expected;
};

Refusal refused_boxes(Life& life, World& world, Attempt& attempt) {
  Random& random = life.random;
  switch (random.below(4)) {
    case 0: {
      std::vector<Handle> handles(attempt.boxes.size());
      attempt.box().min.y = one_in(random, 2) ? attempt.box().max.y + 1 : -2e11;
      const Refusal out{world.insert(BoxView(attempt.boxes), handles), StatusCode::bad_box};
      EXPECT_EQ(std::count(handles.begin(), handles.end(), Handle{}), std::ssize(handles));
      return out;
    }
    case 1:
      attempt.handle() = stale_handle(life, attempt.handle());
      return {world.move(attempt.handles, BoxView(attempt.boxes)), StatusCode::stale_handle};
    case 2:
      attempt.box().max.z = one_in(random, 2) ? double{kNoNumber} : INFINITY;
      return {world.move(attempt.handles, BoxView(attempt.boxes)), StatusCode::bad_box};
    default:
      attempt.handle() =
          one_in(random, 2) ? attempt.handles[attempt.at == 0 ? 1 : 0] : stale_handle(life, attempt.handle());
      return {world.remove(attempt.handles), StatusCode::stale_handle};
  }
}

Refusal refused_columns(Life& life, World& world, Attempt& attempt) {
  Random& random = life.random;
  const auto tables = static_cast<LevelTableId>(life.model.tables.size());
  switch (random.below(5)) {
    case 0:
      attempt.handle() = stale_handle(life, attempt.handle());
      return {world.set_layers(attempt.handles, attempt.column(5u)), StatusCode::stale_handle};
    case 1:
      attempt.handle() = stale_handle(life, attempt.handle());
      return {world.set_values(attempt.handles, attempt.column(5u)), StatusCode::stale_handle};
    case 2: {
      const auto bad = any_of<DistanceRange>(random, {{5, 4}, {-1, 4}, {kNoNumber, 4}});
      return {world.set_distances(attempt.handles, attempt.column(bad)), StatusCode::bad_argument};
    }
    case 3:
      return {world.set_levels(attempt.handles, attempt.column(tables)), StatusCode::bad_argument};
    default: {
      const OccluderPlacement unknown{.occluder = 77};
      return {world.set_occluders(attempt.handles, attempt.column(unknown)), StatusCode::bad_argument};
    }
  }
}

// Where a cull that is refused would write, and must not.
struct Untouched {
  explicit Untouched(std::size_t count) : ids(count, 0xabababab), masks(count, 7), levels(count, 7) {}

  void expect_as_before() const {
    ASSERT_EQ(std::count(ids.begin(), ids.end(), 0xabababab), std::ssize(ids));
    ASSERT_EQ(std::count(masks.begin(), masks.end(), 7), std::ssize(masks));
    ASSERT_EQ(std::count(levels.begin(), levels.end(), 7), std::ssize(levels));
  }

  std::vector<std::uint32_t> ids;
  std::vector<std::uint8_t> masks, levels;
};

}  // namespace

// By the first lane alone: what it left behind its twin would tell from then on.
void refuse_change(Life& life) {
  Random& random = life.random;
  const std::vector<ObjectId> who = life.model.some(random, 2 + random.below(300));
  if (who.size() < 2) return;
  Attempt attempt{life.model.handles(who), {}, below(random, who.size())};
  for (std::size_t i = 0; i < who.size(); ++i) attempt.boxes.push_back(life.any_box());
  const Refusal refusal = one_in(random, 2) ? refused_boxes(life, life.world(), attempt)
                                            : refused_columns(life, life.world(), attempt);
  ASSERT_EQ(refusal.status.code(), refusal.expected) << refusal.status.message();
  expect_objects(life.world(), life.model, life.model.standing);
}

// Nor does a culler learn from it: levels depend on what it remembers.
void refuse_cull(Life& life) {
  Random& random = life.random;
  const World& world = life.world();
  Untouched out(cull_capacity(world));
  CullOutput output{out.ids, out.masks, out.levels, {}};
  std::vector<CullView> views(1, CullView{.view = life.any_view()});
  CullOptions options;
  options.levels.key = random.below(4), options.levels.cut = one_in(random, 4);
  const OcclusionBuffer never_begun;
  const ShadowCasters nobody;
  StatusCode expected = StatusCode::bad_argument;
  switch (random.below(9)) {
    case 0:
      output.ids = output.ids.subspan(1), expected = StatusCode::buffer_too_small;
      break;
    case 1:
      output.masks = output.masks.subspan(1), expected = StatusCode::buffer_too_small;
      break;
    case 2:
      output.levels = output.levels.subspan(1), expected = StatusCode::buffer_too_small;
      break;
    case 3:
      views.resize(kMaxViews + 1, views[0]);
      break;
    case 4:
      views.push_back(views[0]);
      views[1].view.view.world_to_eye.m[12] = kNoNumber, expected = StatusCode::bad_view;
      break;
    case 5:
      views[0].occlusion = &never_begun, expected = StatusCode::stale_buffer;
      break;
    case 6:
      views[0].casters = &nobody, expected = StatusCode::stale_buffer;
      break;
    case 7:
      views[0].distance_view = 1 + random.below(9);
      break;
    default:
      options.jobs = {[](void*, std::uint32_t, void (*)(void*, std::uint32_t), void*) {}, nullptr, 65};
  }
  const Result<CullResult> refused =
      life.first().cullers[random.below(2)].cull(world, views, options, output);
  ASSERT_FALSE(refused);
  ASSERT_EQ(refused.error().code(), expected) << refused.error().message();
  out.expect_as_before();
}

}  // namespace sightline::lives
