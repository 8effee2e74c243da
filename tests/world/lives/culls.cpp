#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <sightline/shadows.hpp>

#include "world/lives/operations.hpp"

namespace sightline::lives {
namespace {

// What all lanes are asked for.
struct Frame {
  std::vector<CullView> views;
  CullOptions options;
  Asked asked;
  std::size_t culler = 0;
};

// Values stand where the ids would, and each view sees by itself what it sees among others.
void expect_the_same_otherwise(Life& life, Lane& lane, const Frame& frame, const Answer& answer) {
  const Answer values = ask(lane.plain, lane.world, frame.views, {.values_for_ids = true}, {.masks = false});
  ASSERT_EQ(values.ids.size(), answer.ids.size());
  for (std::size_t i = 0; i < answer.ids.size(); ++i)
    ASSERT_EQ(values.ids[i], life.model.objects[answer.ids[i]].value);
  for (std::size_t v = 0; v < frame.views.size() && frame.asked.masks; ++v) {
    if (frame.views[v].distance_view != kOwnView) continue;
    std::vector<ObjectId> expected;
    for (std::size_t i = 0; i < answer.ids.size(); ++i)
      if (answer.masks[i] >> v & 1) expected.push_back(answer.ids[i]);
    Answer alone = ask(lane.plain, lane.world, {&frame.views[v], 1}, {}, {.masks = false});
    std::sort(expected.begin(), expected.end()), std::sort(alone.ids.begin(), alone.ids.end());
    ASSERT_EQ(alone.ids, expected) << "of view " << v << " alone";
  }
}

void cull(Life& life, const Frame& frame) {
  Answer of_first;
  const bool otherwise = one_in(life.random, 3);
  for (const auto& lane : life.lanes) {
    CullOptions options = frame.options;
    if (lane->kind == Lane::twin) options.jobs = life.any_jobs();
    Answer answer = ask(lane->cullers[frame.culler], lane->world, frame.views, options, frame.asked);
    if (lane->kind == Lane::twin) {
      expect_same(of_first, answer);
      continue;
    }
    expect_right(life.model, frame.views, answer);
    LevelMemory& memory = lane->memory[frame.culler][options.levels.key];
    if (frame.asked.levels && !testing::Test::HasFailure())
      memory.expect_right(life.model, frame.views, options.levels, answer);
    if (otherwise && !testing::Test::HasFailure()) expect_the_same_otherwise(life, *lane, frame, answer);
    if (lane->kind == Lane::first) of_first = std::move(answer);
  }
}

// Of images small enough for occlusion.
std::vector<CullView> any_small_views(Life& life, std::size_t most) {
  std::vector<CullView> out = life.any_views(one_in(life.random, 2));
  out.resize(std::min(out.size(), most));
  for (CullView& view : out) {
    if (view.distance_view != kOwnView) view.distance_view = 0;
    view.view.view.width = std::min(view.view.view.width, 300u);
    view.view.view.height = std::min(view.view.view.height, 200u);
  }
  return out;
}

std::vector<CullView> without_what_hides(std::vector<CullView> views) {
  for (CullView& view : views) view.occlusion = nullptr, view.casters = nullptr;
  return views;
}

// How many bits of masks are gone; fails where there are new ones.
std::uint64_t hidden_of(Life& life, const Answer& all, const Answer& left) {
  const std::vector<std::uint8_t> before = masks_by_id(life.model, all.ids, all.masks);
  const std::vector<std::uint8_t> after = masks_by_id(life.model, left.ids, left.masks);
  std::uint64_t hidden = 0;
  for (std::size_t id = 0; id < before.size(); ++id) {
    EXPECT_EQ(after[id] & ~before[id], 0) << "occlusion shows object " << id;
    for (unsigned gone = before[id] & ~unsigned{after[id]}; gone != 0; gone &= gone - 1) ++hidden;
  }
  return hidden;
}

// A light that shines on what the first view sees: its map is one view more.
void add_shadow_map(Life& life, std::vector<CullView>& views, ShadowCasters& casters) {
  Random& random = life.random;
  const auto radius = static_cast<float>(life.plan.radius);
  Light light;
  light.kind = static_cast<LightKind>(random.below(3));
  light.direction = random.direction();
  light.position = life.any_point();
  light.range = radius * random.between(0.1f, 2), light.reach = radius * random.between(0.1f, 2);
  const DepthRange depths{0, radius * random.between(0.05f, 1.5f)};
  const std::uint32_t face = light.kind == LightKind::point ? random.below(6) : 0;
  const Result<WorldView> map = shadow_view(light, views[0].view, depths, 64 + random.below(1000), face);
  if (!map || !casters.begin(*map, views[0].view, depths)) return;
  views.push_back({.view = *map, .distance_view = 0, .casters = &casters});
}

void expect_sums(const ViewStats& stats) {
  ASSERT_EQ(stats.objects, stats.outside + stats.by_layers + stats.by_distances + stats.by_casters +
                               stats.by_area + stats.hidden + stats.visible);
  ASSERT_EQ(stats.chunks, stats.chunks_outside + stats.chunks_dropped + stats.chunks_hidden +
                              stats.chunks_whole + stats.chunks_opened);
}

// As many are visible as the cull wrote, and as many hidden.
void expect_inspected(Life& life, Lane& lane, std::span<const CullView> views, const Answer& answer,
                      std::uint64_t hidden) {
  const Result<Inspection> found = lane.inspector.inspect(lane.world, views);
  ASSERT_TRUE(found) << found.error().message();
  std::uint64_t objects = 0, sectors = 0, gone = 0;
  for (const DebugBox& box : found->boxes)
    if (box.kind == DebugBoxKind::sector) ++sectors, objects += box.objects;
  ASSERT_EQ(objects, life.model.all().size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    const ViewStats& stats = found->views[v];
    const auto seen = std::count_if(answer.masks.begin(), answer.masks.end(),
                                    [&](std::uint8_t mask) { return (mask >> v & 1) != 0; });
    ASSERT_EQ(stats.visible, static_cast<std::uint64_t>(seen)) << "in view " << v;
    ASSERT_EQ(stats.sectors, sectors);
    expect_sums(stats);
    gone += stats.hidden + stats.by_casters;
  }
  ASSERT_EQ(gone, hidden);
}

}  // namespace

void cull_views(Life& life) {
  Random& random = life.random;
  Frame frame;
  frame.views = life.any_views(one_in(random, 3));
  frame.culler = random.below(2);
  frame.asked.masks = !one_in(random, 3);
  frame.asked.levels = one_in(random, 2);
  frame.asked.fades = frame.asked.levels && one_in(random, 2);
  LevelOptions& levels = frame.options.levels;
  levels.view = static_cast<std::uint32_t>(below(random, frame.views.size()));
  levels.key = random.below(3);
  if (!one_in(random, 3)) levels.hysteresis = random.between(0, 0.4f);
  if (one_in(random, 2)) levels.fade = random.unit();
  if (one_in(random, 3)) levels.scale = std::exp(random.between(-1, 1));
  levels.cut = one_in(random, 8);
  cull(life, frame);
}

// A camera that goes on through the world while others move and come and go: levels depend on its last
// frames.
void walk(Life& life) {
  Random& random = life.random;
  const auto radius = static_cast<float>(life.plan.radius);
  Frame frame;
  frame.asked = {.masks = one_in(random, 2), .levels = true, .fades = one_in(random, 2)};
  LevelOptions& levels = frame.options.levels;
  levels.key = 3;
  levels.hysteresis = random.between(0, 0.4f), levels.fade = random.unit();
  CullView view;
  if (one_in(random, 3)) view.layers = 7;
  if (one_in(random, 4)) view.min_area = 20;
  view.view.origin = life.any_point();
  Camera camera;
  camera.forward = {random.between(-1, 1), 0.1f, random.between(-1, 1)};
  camera.far_plane = 4 * radius + 10;
  if (one_in(random, 6)) camera.orthographic_height = radius;
  const float stride = any_of(random, {0.0f, 0.05f, 1.0f, 0.03f * radius});
  for (std::uint32_t frames = 2 + random.below(12); frames > 0 && !testing::Test::HasFailure(); --frames) {
    levels.cut = one_in(random, 8);
    camera.eye.x += random.between(-stride, stride), camera.eye.z += random.between(-stride, stride);
    if (one_in(random, 4)) camera.forward.x += random.between(-0.1f, 0.1f);
    const Result<View> seen = make_view(camera, 640, 480);
    if (!seen) return;
    view.view.view = *seen;
    frame.views = {view};
    if (one_in(random, 3)) frame.views.push_back({.view = life.any_view()});
    cull(life, frame);
    if (one_in(random, 3)) step(life, life.model.some(random, random.below(6)));
    if (one_in(random, 12)) remove(life, 1 + random.below(3));
    if (one_in(random, 12)) insert(life, 1 + random.below(3));
    if (one_in(random, 12)) give_columns(life);
  }
}

// Leaves some of what the frustums leave, in the same bits with jobs, and at the costs that it promises. What
// it hides exact rays judge in random_worlds_test.cpp.
void cull_automatically(Life& life) {
  Random& random = life.random;
  if (!life.plan.occluders) return;
  const std::vector<CullView> views = any_small_views(life, 3);
  CullOptions options{.occlusion = Occlusion::automatic};
  if (!one_in(random, 3)) options.costs.object = std::pow(10.0f, random.between(2, 7));
  options.buffer.coverage = one_in(random, 3) ? Coverage::area : Coverage::centres;
  options.buffer.scale = 1u << random.below(3);
  Answer of_first;
  for (const auto& lane : life.lanes) {
    options.jobs = lane->kind == Lane::twin ? life.any_jobs() : JobSystem{};
    Answer left = ask(lane->automatic, lane->world, views, options, {});
    const double alone = left.result.frustum_cost;
    ASSERT_LE(left.result.cost, 1.05 * (1 + 1e-6) * alone + 1e-3);
    lane->cost += left.result.cost, lane->frustum_cost += alone;
    ASSERT_LE(lane->cost, 1.02 * (1 + 1e-6) * lane->frustum_cost + 1e-3);
    if (lane->kind == Lane::twin) {
      expect_same(of_first, left);
      continue;
    }
    const Answer all = ask(lane->plain, lane->world, views, {}, {});
    expect_right(life.model, views, all);
    hidden_of(life, all, left);
    if (lane->kind == Lane::first) of_first = std::move(left);
  }
}

// Views with buffers that boxes were drawn into, and at times a shadow map: culls, ranges and inspectors
// agree on what those hide.
void hide(Life& life) {
  Random& random = life.random;
  std::vector<CullView> views = any_small_views(life, 2);
  std::vector<OcclusionBuffer> buffers(views.size());
  ShadowCasters casters;
  std::vector<WorldBox> walls;
  for (const ObjectId id : life.model.some(random, 1 + random.below(40)))
    walls.push_back(life.model.objects[id].given);
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (one_in(random, 4)) continue;
    ASSERT_TRUE(buffers[v].begin(
        views[v].view, {one_in(random, 3) ? Coverage::area : Coverage::centres, 1u << random.below(3)}));
    ASSERT_TRUE(buffers[v].draw_boxes(BoxView(walls)));
    views[v].occlusion = &buffers[v];
  }
  if (one_in(random, 2)) add_shadow_map(life, views, casters);
  Answer of_first;
  for (const auto& lane : life.lanes) {
    CullOptions options;
    if (lane->kind == Lane::twin) options.jobs = life.any_jobs();
    follow_order(life, *lane);
    Answer left = ask(lane->plain, lane->world, views, options, {});
    const Result<RangeResult> ranges = lane->ranger.cull(lane->world, lane->order, views);
    ASSERT_TRUE(ranges) << ranges.error().message();
    ASSERT_EQ(ranges->objects, left.ids.size());
    if (lane->kind == Lane::twin) {
      expect_same(of_first, left);
      continue;
    }
    const std::vector<CullView> open = without_what_hides(views);
    const Answer all = ask(lane->plain, lane->world, open, {}, {});
    expect_right(life.model, open, all);
    expect_inspected(life, *lane, views, left, hidden_of(life, all, left));
    if (lane->kind == Lane::first) of_first = std::move(left);
  }
}

void inspect(Life& life) {
  const std::vector<CullView> views = life.any_views(one_in(life.random, 2));
  for (const auto& lane : life.lanes)
    expect_inspected(life, *lane, views, ask(lane->plain, lane->world, views, {}, {}), 0);
}

}  // namespace sightline::lives
