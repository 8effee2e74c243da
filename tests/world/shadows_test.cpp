// Who can throw a shadow on what a camera sees: never one too few, by segments from lit points to the light.
#include <sightline/shadows.hpp>
#include <sightline/world.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/cull.hpp"
#include "support/random_views.hpp"
#include "support/rounds.hpp"
#include "support/run_threads.hpp"
#include "support/shadow_points.hpp"
#include "support/solid_boxes.hpp"

namespace sightline {
namespace {

using namespace test;
using scene::Random;

// A ray's part in a box: from … to, of the whole; empty where from > to.
struct Part {
  double from = 0, to = 1;
};
Part part_in(const WorldPoint& a, const glm::dvec3& along, const WorldBox& box) {
  Part part;
  const double from[] = {a.x, a.y, a.z}, low[] = {box.min.x, box.min.y, box.min.z},
               high[] = {box.max.x, box.max.y, box.max.z};
  for (int axis = 0; axis < 3; ++axis) {
    const double d = along[axis];
    if (d == 0) {
      if (from[axis] < low[axis] || from[axis] > high[axis]) part.to = -1;
      continue;
    }
    const double s = (low[axis] - from[axis]) / d, t = (high[axis] - from[axis]) / d;
    part.from = std::max(part.from, std::min(s, t)), part.to = std::min(part.to, std::max(s, t));
  }
  return part;
}

// From a lit point as far as anything can throw a shadow on it.
glm::dvec3 towards_light(const WorldView& shadow, const WorldPoint& p) {
  const glm::dmat4 to_world = glm::inverse(to_double(shadow.view.world_to_eye));
  if (is_orthographic(shadow.view)) return 4000.0 * glm::dvec3(to_world[2]);
  return glm::dvec3(to_world[3]) - about(p, shadow.origin);
}

// The point moved as far as the filter may look, in the shadow view's texels.
WorldPoint looked_up(Random& random, const WorldView& shadow, const WorldPoint& p,
                     const ShadowFilter& filter) {
  const glm::dmat4 to_world = glm::inverse(to_double(shadow.view.world_to_eye));
  const double w = on_image(shadow, p).z;
  const auto texels = [&](int axis, std::uint32_t pixels) {
    const double metres = 2 * w / (pixels * to_double(shadow.view.eye_to_clip)[axis][axis]);
    return static_cast<double>(random.between(-filter.texels, filter.texels)) * metres;
  };
  const glm::dvec3 by = texels(0, shadow.view.width) * glm::dvec3(to_world[0]) +
                        texels(1, shadow.view.height) * glm::dvec3(to_world[1]) +
                        0.99 * static_cast<double>(filter.metres) * to_double(random.direction());
  return {p.x + by.x, p.y + by.y, p.z + by.z};
}

struct Case {
  WorldView camera, shadow;
  DepthRange depths;
  ShadowFilter filter;
};

// Lights of all kinds beside cameras of all kinds, here and far from the origin.
Case random_case(Random& random) {
  for (;;) {
    Case out;
    const double far_out = random.below(3) == 0 ? 5e6 : 0;
    out.camera = {test::random_view(random, kPlace), {far_out, 0, -far_out}};
    if (random.below(2) == 0) out.depths = {random.between(0, 20), random.between(25, 120)};
    Light light;
    light.kind = static_cast<LightKind>(random.below(3));
    light.direction = random.direction();
    const Vec3 at = random.inside(kPlace);
    light.position = {far_out + at.x, at.y, -far_out + at.z};
    light.cone = random.between(0.2f, 2.8f), light.range = random.between(20, 200);
    light.reach = random.between(10, 300);
    if (random.below(2) == 0) out.filter = {random.between(0, 4), random.below(2) * random.between(0, 0.5f)};
    const std::uint32_t face = light.kind == LightKind::point ? random.below(6) : 0;
    const auto shadow = shadow_view(light, out.camera, out.depths, 64 + random.below(2000), face);
    ShadowCasters probe;
    if (!shadow || !probe.begin(*shadow, out.camera, out.depths, out.filter)) continue;
    out.shadow = *shadow;
    return out;
  }
}

struct Standing {
  World world;
  std::vector<WorldBox> boxes;
  std::vector<Handle> handles;
};

Standing standing_about(Random& random, const WorldPoint& origin, std::size_t count) {
  Standing out;
  for (std::size_t i = 0; i < count; ++i) {
    const Box b = test::random_box(random, kPlace);
    out.boxes.push_back({{origin.x + b.min.x, origin.y + b.min.y, origin.z + b.min.z},
                         {origin.x + b.max.x, origin.y + b.max.y, origin.z + b.max.z}});
  }
  out.handles.resize(count);
  EXPECT_TRUE(out.world.insert(BoxView(out.boxes), out.handles));
  for (std::size_t i = 0; i < count; ++i) out.boxes[i] = out.world.box(out.handles[i]);
  return out;
}

std::set<ObjectId> seen_by(const World& world, const CullView& view) {
  Culler culler;
  std::vector<ObjectId> ids(cull_capacity(world));
  const std::size_t count = test::cull(culler, world, {&view, 1}, ids).count;
  return {ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count)};
}

// A point that the camera sees in the range, anywhere.
bool random_point(Random& random, const Case& c, WorldPoint& out) {
  const Vec3 at = random.inside(kPlace);
  out = {c.camera.origin.x + at.x, at.y, c.camera.origin.z + at.z};
  const double depth = depth_along(c.camera, out);
  return is_seen(c.camera, out) && depth >= c.depths.near_plane && depth <= c.depths.far_plane;
}

// No object that a segment from the lit point passes on its way to the light is missing.
std::size_t expect_kept(const Standing& s, const Case& c, const WorldPoint& lit,
                        const std::set<ObjectId>& all, const std::set<ObjectId>& kept, double beyond) {
  const glm::dvec3 along = towards_light(c.shadow, lit);
  std::size_t casting = 0;
  for (std::size_t i = 0; i < s.boxes.size(); ++i) {
    const Part part = part_in(lit, along, s.boxes[i]);
    const ObjectId id = s.handles[i].index;
    if (!(part.from <= part.to) || part.to < beyond || !all.contains(id)) continue;
    ++casting;
    EXPECT_TRUE(kept.contains(id)) << "lost caster " << i;
  }
  return casting;
}

TEST(ShadowCasters, LoseNobodyWhoStandsBetweenAPointInViewAndTheLight) {
  std::size_t casting = 0, kept = 0, could = 0;
  for (std::uint32_t seed = 0; seed < 1000; ++seed) {
    Random random(seed);
    const Case c = random_case(random);
    const Standing s = standing_about(random, c.camera.origin, 60 + random.below(200));
    ShadowCasters casters;
    ASSERT_TRUE(casters.begin(c.shadow, c.camera, c.depths, c.filter));
    const std::set<ObjectId> all = seen_by(s.world, {.view = c.shadow}),
                             left = seen_by(s.world, {.view = c.shadow, .casters = &casters});
    could += all.size(), kept += left.size();
    for (const ObjectId id : left) ASSERT_TRUE(all.contains(id));
    for (int i = 0; i < 60; ++i) {
      WorldPoint p;
      if (!random_point(random, c, p)) continue;
      p = looked_up(random, c.shadow, p, c.filter);
      if (is_seen(c.shadow, p)) casting += expect_kept(s, c, p, all, left, 0);
    }
    ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
    // Box by box the same is said, but where rounding decides.
    for (std::size_t i = 0; i < s.boxes.size(); ++i) {
      WorldBox b = s.boxes[i];
      if (!all.contains(s.handles[i].index)) continue;
      if (casters.may_cast(b)) ASSERT_TRUE(left.contains(s.handles[i].index)) << "seed " << seed;
      const double play = 0.01;
      b = {{b.min.x - play, b.min.y - play, b.min.z - play},
           {b.max.x + play, b.max.y + play, b.max.z + play}};
      if (!casters.may_cast(b)) ASSERT_FALSE(left.contains(s.handles[i].index)) << "seed " << seed;
    }
  }
  EXPECT_GT(casting, 10000u);
  EXPECT_LT(kept, could / 10 * 9);
}

// The nearest object at a pixel centre, and where it is met.
bool visible_point(const Standing& s, const Case& c, std::uint32_t x, std::uint32_t y, WorldPoint& out) {
  const glm::dmat4 to_world =
      glm::inverse(to_double(c.camera.view.eye_to_clip) * to_double(c.camera.view.world_to_eye));
  const double across = 2 * (x + 0.5) / c.camera.view.width - 1,
               up = 1 - 2 * (y + 0.5) / c.camera.view.height;
  const auto at = [&](double z) {
    const glm::dvec4 p = to_world * glm::dvec4(across, up, z, 1);
    return glm::dvec3(p) / p.w;
  };
  // Reversed depth begins at 1; an infinite far plane ends a little before.
  const bool reversed = depth_along(c.camera, {c.camera.origin.x + at(0.1).x, c.camera.origin.y + at(0.1).y,
                                               c.camera.origin.z + at(0.1).z}) >
                        depth_along(c.camera, {c.camera.origin.x + at(0.9).x, c.camera.origin.y + at(0.9).y,
                                               c.camera.origin.z + at(0.9).z});
  const glm::dvec3 near = at(reversed ? 1 : 0), far = at(reversed ? 1e-6 : 1 - 1e-6), along = far - near;
  const WorldPoint from{c.camera.origin.x + near.x, c.camera.origin.y + near.y, c.camera.origin.z + near.z};
  double nearest = 2;
  for (const WorldBox& box : s.boxes) {
    const Part part = part_in(from, along, box);
    if (part.from <= part.to) nearest = std::min(nearest, part.from);
  }
  if (nearest > 1) return false;
  out = {from.x + nearest * along.x, from.y + nearest * along.y, from.z + nearest * along.z};
  const double depth = depth_along(c.camera, out);
  return depth >= c.depths.near_plane && depth <= c.depths.far_plane;
}

TEST(ShadowCasters, LoseNobodyWhoShadesWhatIsVisible) {
  std::size_t casting = 0, by_planes = 0, by_objects = 0, by_depth = 0, unsure = 0;
  const std::uint32_t cases = test::rounds(400);
  for (std::uint32_t seed = 0; seed < cases; ++seed) {
    Random random(5000 + seed);
    const Case c = random_case(random);
    const Standing s = standing_about(random, c.camera.origin, 60 + random.below(200));
    OcclusionBuffer depth;
    ASSERT_TRUE(depth.begin(c.camera, {Coverage::centres, 1u << random.below(3)}));
    ASSERT_TRUE(depth.draw_boxes(BoxView(s.boxes)));
    const std::set<ObjectId> all = seen_by(s.world, {.view = c.shadow}),
                             seen = seen_by(s.world, {.view = c.camera, .occlusion = &depth});
    const std::vector<ObjectId> visible(seen.begin(), seen.end());
    ShadowCasters casters;
    const CullView view{.view = c.shadow, .casters = &casters};
    ASSERT_TRUE(casters.begin(c.shadow, c.camera, c.depths, c.filter));
    by_planes += seen_by(s.world, view).size();
    ASSERT_TRUE(casters.receive(s.world, visible));
    by_objects += seen_by(s.world, view).size();
    ASSERT_TRUE(casters.receive(s.world, visible, &depth));
    const std::set<ObjectId> left = seen_by(s.world, view);
    by_depth += left.size();
    for (int i = 0; i < 60; ++i) {
      WorldPoint p;
      if (!visible_point(s, c, random.below(c.camera.view.width), random.below(c.camera.view.height), p))
        continue;
      const WorldPoint lookup = looked_up(random, c.shadow, p, c.filter);
      // The object that was met stands there itself; beyond, whoever is nearer to the light counts.
      if (is_seen(c.shadow, lookup)) casting += expect_kept(s, c, lookup, all, left, 1e-9);
    }
    ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
    for (std::size_t i = 0; i < s.boxes.size(); ++i)
      if (all.contains(s.handles[i].index) &&
          left.contains(s.handles[i].index) != casters.may_cast(s.boxes[i]))
        ++unsure;  // rounding decides
  }
  EXPECT_GT(2 * casting, 15 * cases);
  EXPECT_LT(by_objects, by_planes);
  EXPECT_LT(by_depth, by_objects);
  EXPECT_LT(unsure, by_depth / 100);
}

// Of a town's houses few throw a shadow into the street that somebody stands in.
TEST(ShadowCasters, AreFewWhereHousesHideMostOfATown) {
  Random random(11);
  std::vector<Box> boxes{{{-400, -1, -400}, {400, 0, 400}}};
  for (float x = -400; x < 400; x += 20)
    for (float z = -400; z < 400; z += 20) {
      if (std::fabs(x + 10) > 15)
        boxes.push_back({{x + 3, 0, z + 3}, {x + 19, random.between(5, 25), z + 19}});
    }
  World world;
  std::vector<Handle> handles(boxes.size());
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  const WorldView camera{*make_view({.eye = {0, 1.7f, 100}, .far_plane = 300}, 1280, 720), {}};
  const WorldView shadow = *shadow_view({.direction = {1, -1.5f, 0.3f}, .reach = 300}, camera, {}, 2048);
  OcclusionBuffer depth;
  ASSERT_TRUE(depth.begin(camera));
  ASSERT_TRUE(depth.draw_boxes(BoxView(boxes)));
  const std::set<ObjectId> seen = seen_by(world, {.view = camera, .occlusion = &depth});
  const std::vector<ObjectId> visible(seen.begin(), seen.end());
  ShadowCasters casters;
  ASSERT_TRUE(casters.begin(shadow, camera));
  const CullView view{.view = shadow, .casters = &casters};
  const std::size_t all = seen_by(world, {.view = shadow}).size(), by_planes = seen_by(world, view).size();
  ASSERT_TRUE(casters.receive(world, visible));
  const std::size_t by_objects = seen_by(world, view).size();
  ASSERT_TRUE(casters.receive(world, visible, &depth));
  const std::size_t by_depth = seen_by(world, view).size();
  EXPECT_GT(by_depth, 20u);
  EXPECT_LT(by_planes, 3 * all / 5) << all;
  EXPECT_LE(by_objects, by_planes);  // the ground is one object, and seen
  EXPECT_LT(by_depth, by_objects / 2) << by_objects;
}

// In one call with layers, distances, small things and threads: what each leaves of the others.
TEST(ShadowCasters, StandBesideAllElseThatAViewAsks) {
  std::size_t kept = 0, could = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Random random(9000 + seed);
    const Case c = random_case(random);
    const Standing s = standing_about(random, c.camera.origin, 200);
    World columns;
    std::vector<Handle> handles(s.boxes.size());
    std::vector<std::uint32_t> layers;
    std::vector<DistanceRange> distances;
    for (std::size_t i = 0; i < s.boxes.size(); ++i)
      layers.push_back(1u << random.below(3)), distances.push_back({0, random.between(20, 200)});
    ASSERT_TRUE(columns.insert(BoxView(s.boxes), handles,
                               {.layers = layers, .distances = std::span<const DistanceRange>(distances)}));
    ASSERT_EQ(handles, s.handles);
    ShadowCasters casters;
    ASSERT_TRUE(casters.begin(c.shadow, c.camera, c.depths, c.filter));
    const std::array views{
        CullView{.view = c.camera, .layers = 3},
        CullView{.view = c.shadow, .layers = 6, .distance_view = 0, .casters = &casters},
        CullView{.view = c.shadow, .layers = 6, .min_area = 2, .distance_view = 0, .casters = &casters}};
    auto without = views;
    without[1].casters = without[2].casters = nullptr;
    Culler culler;
    const CullOptions options{.jobs = {test::run_threads, nullptr, 3}};
    std::vector<ObjectId> ids(cull_capacity(columns, options)), all(ids.size());
    std::vector<std::uint8_t> masks(ids.size()), all_masks(ids.size());
    const std::size_t count = test::cull(culler, columns, views, ids, masks, options).count,
                      most = test::cull(culler, columns, without, all, all_masks, options).count;
    std::size_t at = 0;
    for (std::size_t i = 0; i < most; ++i) {
      const std::uint8_t got = at < count && ids[at] == all[i] ? masks[at++] : std::uint8_t{0};
      ASSERT_EQ(got & 1, all_masks[i] & 1);
      ASSERT_EQ(got & ~all_masks[i], 0);
      const bool casts = casters.may_cast(columns.box(columns.handle(all[i])));
      if (casts) ASSERT_EQ(got, all_masks[i]);
      kept += got >> 1 & 1, could += all_masks[i] >> 1 & 1;
    }
    ASSERT_EQ(at, count);
  }
  EXPECT_GT(kept, could / 10);
  EXPECT_LT(kept, could / 10 * 9);
}

TEST(ShadowCasters, AreRefusedBesideAnotherView) {
  const WorldView camera{*make_view({}, 64, 64), {}}, shadow = *shadow_view({}, camera, {}, 256);
  World world;
  const std::array boxes{Box{{-1, -1, -9}, {1, 1, -8}}};
  std::array<Handle, 1> handles;
  ASSERT_TRUE(world.insert(BoxView(boxes), handles));
  std::vector<ObjectId> ids(cull_capacity(world));
  ShadowCasters casters;
  Culler culler;
  const std::array<ObjectId, 1> first{0}, none{7};
  const auto code = [&](const WorldView& view) {
    return culler.cull(world, {.view = view, .casters = &casters}, ids).error().code();
  };
  EXPECT_EQ(code(shadow), StatusCode::stale_buffer);
  EXPECT_EQ(casters.receive(world, first).code(), StatusCode::stale_buffer);
  EXPECT_FALSE(casters.begun());
  EXPECT_TRUE(casters.may_cast({{9e9, 0, 0}, {9e9, 0, 0}}));
  EXPECT_EQ(casters.begin(shadow, {View{{}, {}, 0, 0}, {}}).code(), StatusCode::bad_view);
  EXPECT_EQ(casters.begin(shadow, camera, {}, {-1, 0}).code(), StatusCode::bad_argument);
  EXPECT_EQ(casters.begin(shadow, camera, {4, 3}).code(), StatusCode::bad_argument);
  ASSERT_TRUE(casters.begin(shadow, camera));
  EXPECT_EQ(casters.view(), shadow);
  EXPECT_EQ(code(camera), StatusCode::stale_buffer);
  EXPECT_EQ(code(shadow), StatusCode::ok);
  const Status refused = casters.receive(world, none);
  EXPECT_EQ(refused.code(), StatusCode::bad_argument);
  EXPECT_EQ(refused.index(), 0u);
  OcclusionBuffer other;
  EXPECT_EQ(casters.receive(world, first, &other).code(), StatusCode::stale_buffer);
  ASSERT_TRUE(other.begin(shadow));
  EXPECT_EQ(casters.receive(world, first, &other).code(), StatusCode::stale_buffer);
  EXPECT_EQ(test::cull(culler, world, std::array{CullView{.view = shadow, .casters = &casters}}, ids).count,
            1u);
  // Nothing receives: nobody casts.
  ASSERT_TRUE(casters.receive(world, {}));
  EXPECT_EQ(test::cull(culler, world, std::array{CullView{.view = shadow, .casters = &casters}}, ids).count,
            0u);
}

}  // namespace
}  // namespace sightline
