// Instances of worlds beside brute force: each object of each instance tested by itself, in double precision.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include <sightline/instances.hpp>
#include <sightline/projection.hpp>

#include "library/geometry/linear.hpp"
#include "support/placed.hpp"
#include "support/random_views.hpp"
#include "support/run_threads.hpp"

namespace sightline::placed {
namespace {

using namespace geometry;
using namespace test;

constexpr std::array kSizes{120.0f, 40.0f, 10.0f};

// An object as its world was told of it.
struct Twin {
  WorldBox box;  // as stored
  std::uint32_t layers = kAllLayers, value = 0;
  DistanceRange range;
  bool has_levels = false;
};

struct Shown {
  std::unique_ptr<World> world = std::make_unique<World>();
  std::map<ObjectId, Twin> twins;
};

WorldBox moved(const Box& b, const WorldPoint& by) {
  return {{b.min.x + by.x, b.min.y + by.y, b.min.z + by.z}, {b.max.x + by.x, b.max.y + by.y, b.max.z + by.z}};
}

// What kinds of things a random case has.
struct Kinds {
  bool layers = false, distances = false, min_area = false, levels = false, values = false;
};

Shown random_world(scene::Random& random, const Kinds& kinds) {
  Shown out;
  const std::size_t count = random.below(60);
  const WorldPoint at{random.below(4) == 0 ? 3200.0 : 0.0, 0, 0};
  std::vector<WorldBox> boxes;
  std::vector<std::uint32_t> layers, values;
  std::vector<DistanceRange> ranges;
  for (std::size_t i = 0; i < count; ++i) {
    boxes.push_back(moved(random_box(random, {{-40, -20, -40}, {40, 20, 40}}), at));
    layers.push_back(1u << random.below(4)), values.push_back(random.below(1000));
    const float from = random.below(2) ? 0 : random.between(0, 60);
    ranges.push_back({from, from + random.between(0, 400)});
  }
  std::vector<Handle> handles(count);
  ObjectColumns columns;
  if (kinds.layers) columns.layers = std::span<const std::uint32_t>(layers);
  if (kinds.values) columns.values = std::span<const std::uint32_t>(values);
  if (kinds.distances) columns.distances = std::span<const DistanceRange>(ranges);
  EXPECT_TRUE(out.world->insert(boxes, handles, columns));
  const bool has_levels = kinds.levels && random.below(3) > 0;
  if (has_levels) {
    const std::vector<LevelTableId> tables(count, *out.world->add_levels(kSizes));
    EXPECT_TRUE(out.world->set_levels(handles, std::span<const LevelTableId>(tables)));
  }
  for (std::size_t i = 0; i < count; ++i)
    out.twins[handles[i].index] = {out.world->box(handles[i]), kinds.layers ? layers[i] : kAllLayers,
                                   kinds.values ? values[i] : handles[i].index,
                                   kinds.distances ? ranges[i] : DistanceRange{}, has_levels};
  return out;
}

// One object of an instance in one view, in double precision.
struct Sight {
  double depth = 0;     // of its best corner in the worst plane, metres; below 0: outside
  double distance = 0;  // from the eye to its centre, in its world's metres
  double area = 0;      // px²
  double size = 0;      // pixels
};

Sight sight_of(const CullView& view, const WorldPoint& eye_origin, const View& eye_view,
               const InstancePlacement& placement, const WorldBox& b) {
  const WorldPoint &o = placement.origin, &about = view.view.origin;
  glm::dmat4 placed = to_double(placement.transform);
  placed[3] += glm::dvec4(o.x - about.x, o.y - about.y, o.z - about.z, 0);
  const View& v = view.view.view;
  const glm::dmat4 rows = glm::transpose(to_double(v.eye_to_clip) * to_double(v.world_to_eye) * placed);
  const double scale = std::cbrt(glm::determinant(glm::dmat3(placed)));
  Sight out;
  out.depth = 1e300;
  for (const glm::dvec4& plane : {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
                                  rows[2], rows[3] - rows[2]}) {
    const double length = glm::length(glm::dvec3(plane));
    if (length < 1e-12 * std::fabs(plane.w)) continue;
    const glm::dvec3 corner(plane.x >= 0 ? b.max.x : b.min.x, plane.y >= 0 ? b.max.y : b.min.y,
                            plane.z >= 0 ? b.max.z : b.min.z);
    out.depth = std::min(out.depth, scale * (glm::dot(glm::dvec3(plane), corner) + plane.w) / length);
  }
  const glm::dvec3 low(b.min.x, b.min.y, b.min.z), high(b.max.x, b.max.y, b.max.z),
      centre = 0.5 * (low + high);
  const auto from = [&](const View& seen_by, const WorldPoint& origin) {
    glm::dmat4 there = to_double(placement.transform);
    there[3] += glm::dvec4(o.x - origin.x, o.y - origin.y, o.z - origin.z, 0);
    const glm::dvec3 eye(glm::inverse(to_double(seen_by.world_to_eye) * there)[3]);
    return glm::length(centre - eye);
  };
  out.distance = from(eye_view, eye_origin);
  const Projector projector = make_projector(v, {});
  const double radius = 0.5 * glm::length(high - low), own = from(v, about),
               wide = projector.orthographic ? radius * scale
                      : own <= radius        ? 1e30
                                             : radius / own;
  out.size = 2 * projector.pixels_per_metre * wide;
  out.area = std::numbers::pi / 4 * out.size * out.size;
  return out;
}

enum class Verdict { out, in, either };

Verdict judge(const CullView& view, const Sight& sight, const Twin& twin, std::uint32_t instance_layers,
              double tolerance) {
  if ((view.layers & twin.layers) == 0 || (view.layers & instance_layers) == 0) return Verdict::out;
  if (sight.depth < -tolerance) return Verdict::out;
  const double scale = view.distance_scale, d = sight.distance;
  if (d < 0.9999 * scale * twin.range.min - 1e-3 || d > 1.0001 * scale * twin.range.max + 1e-3)
    return Verdict::out;
  if (view.min_area > 0 && sight.area < 0.999 * view.min_area) return Verdict::out;
  const bool far_enough = d > 1.0001 * scale * twin.range.min + 1e-3 || twin.range.min == 0,
             near_enough = d < 0.9999 * scale * twin.range.max - 1e-3,
             large = view.min_area == 0 || sight.area > 1.001 * view.min_area;
  return sight.depth >= 0 && far_enough && near_enough && large ? Verdict::in : Verdict::either;
}

struct Case {
  Kinds kinds;
  std::vector<Shown> shown;
  Instances instances;
  std::vector<InstancePlacement> placements;
  std::vector<Handle> handles;
  std::vector<std::uint32_t> layers;
  std::vector<CullView> views;
  InstanceCullOptions options;
};

void fill(scene::Random& random, Case& c) {
  const auto maybe = [&] { return random.below(3) == 0; };
  c.kinds = {maybe(), maybe(), maybe(), maybe(), maybe()};
  const WorldPoint far{random.below(3) == 0 ? 4e7 : 0.0, 0, random.below(3) == 0 ? -1e6 : 0.0};
  for (std::uint32_t w = 0; w < 1 + random.below(3); ++w) {
    c.shown.push_back(random_world(random, c.kinds));
    EXPECT_EQ(*c.instances.add_world(*c.shown.back().world), w);
  }
  const std::size_t count = 1 + random.below(12);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 at = random.inside(kAround);
    c.placements.push_back({random.below(static_cast<std::uint32_t>(c.shown.size())),
                            random_turn(random, std::exp(random.between(-2, 2)), at), far});
    c.layers.push_back(1u << random.below(4));
  }
  c.handles.resize(count);
  EXPECT_TRUE(c.instances.insert(
      c.placements, c.handles,
      c.kinds.layers ? Strided<const std::uint32_t>(c.layers) : Strided<const std::uint32_t>{}));
  const std::size_t views = 1 + random.below(3);
  for (std::size_t v = 0; v < views; ++v) {
    CullView view{.view = {random_view(random, kAround), far}};
    if (random.below(4) == 0 && v > 0) view.view = c.views[0].view;
    if (c.kinds.layers) view.layers = random.below(16);
    if (c.kinds.min_area) view.min_area = random.between(0, 300);
    view.distance_scale = random.between(0.5f, 2);
    if (random.below(2)) view.distance_view = random.below(static_cast<std::uint32_t>(views));
    c.views.push_back(view);
  }
  c.options.masks = views > 1 || random.below(2);
  c.options.levels = c.kinds.levels;
  c.options.level_options = {.view = random.below(static_cast<std::uint32_t>(views)), .fade = 0.25f};
}

std::uint8_t level_at(double size) {
  std::uint8_t level = 0;
  for (const float limit : kSizes) level += size < static_cast<double>(limit);
  return level;
}

void expect_level(const Case& c, const Said& said, const InstancePlacement& placement, const Twin& twin) {
  if (!twin.has_levels) {
    EXPECT_EQ(said.level, 0);
    return;
  }
  const CullView& by = c.views[c.options.level_options.view];
  const double size = sight_of(by, by.view.origin, by.view.view, placement, twin.box).size;
  EXPECT_LE(level_at(1.001 * size), said.level);
  EXPECT_GE(level_at(0.999 * size), said.level);
  if (said.level == kSizes.size()) return;
  const double limit = kSizes[said.level],
               share = std::clamp((1.25 * limit - size) / (0.25 * limit), 0.0, 1.0);
  EXPECT_NEAR(said.fade, 255 * share, 3);
}

// Returns how many objects were seen, and how many were not.
std::pair<std::size_t, std::size_t> expect_right(const Case& c, const InstanceCullResult& result) {
  const AllSaid said = all_said(result);
  std::size_t seen = 0, culled = 0;
  for (std::size_t i = 0; i < c.placements.size(); ++i) {
    const InstancePlacement& placement = c.placements[i];
    for (const auto& [id, twin] : c.shown[placement.world].twins) {
      const auto found = said.find({c.handles[i].index, id});
      EXPECT_TRUE(found == said.end() || found->second.size() == 1) << "written twice";
      const std::uint8_t mask = found == said.end() ? std::uint8_t{0} : found->second[0].mask;
      for (std::size_t v = 0; v < c.views.size(); ++v) {
        const CullView& view = c.views[v];
        const WorldView& eye = view.distance_view == kOwnView ? view.view : c.views[view.distance_view].view;
        const Verdict verdict = judge(view, sight_of(view, eye.origin, eye.view, placement, twin.box), twin,
                                      c.kinds.layers ? c.layers[i] : kAllLayers, 0.02);
        const bool kept = mask >> v & 1;
        if (c.options.masks || c.views.size() == 1) {
          if (verdict == Verdict::in)
            EXPECT_TRUE(kept) << "lost object " << id << " of " << i << " in view " << v;
          if (verdict == Verdict::out)
            EXPECT_FALSE(kept) << "kept object " << id << " of " << i << " in view " << v;
        }
        kept ? ++seen : ++culled;
      }
      if (mask != 0 && c.options.levels) expect_level(c, found->second[0], placement, twin);
    }
  }
  return {seen, culled};
}

TEST(Instances, EqualBruteForceInAThousandRandomWorldsAndViews) {
  std::size_t seen = 0, culled = 0, shared = 0;
  InstanceCuller threaded;
  for (std::uint32_t seed = 0; seed < 1000; ++seed) {
    scene::Random random(seed);
    Case c;
    fill(random, c);
    InstanceCuller culler;
    const auto result = culler.cull(c.instances, c.views, c.options);
    ASSERT_TRUE(result) << result.error().message();
    const auto [in, out] = expect_right(c, *result);
    ASSERT_FALSE(HasFailure()) << "seed " << seed;
    seen += in, culled += out, shared += result->objects - result->ids.size();
    // So do threads, to the bit, and values stand in the ids' places.
    InstanceCullOptions options = c.options;
    options.jobs = {run_threads, nullptr, 4};
    const auto again = threaded.cull(c.instances, c.views, options);
    ASSERT_TRUE(again);
    ASSERT_TRUE(std::ranges::equal(again->ranges, result->ranges));
    ASSERT_TRUE(std::ranges::equal(again->ids, result->ids));
    ASSERT_TRUE(std::ranges::equal(again->masks, result->masks));
    ASSERT_TRUE(std::ranges::equal(again->levels, result->levels));
    ASSERT_TRUE(std::ranges::equal(again->fades, result->fades));
    options.values_for_ids = true;
    const auto values = threaded.cull(c.instances, c.views, options);
    ASSERT_EQ(values->ids.size(), result->ids.size());
    for (const InstanceRange& range : result->ranges) {
      const auto& twins = c.shown[c.instances.placement(c.instances.handle(range.instance)).world].twins;
      for (std::size_t i = range.first; i < std::size_t{range.first} + range.count; ++i)
        ASSERT_EQ(values->ids[i], twins.at(result->ids[i]).value);
    }
  }
  EXPECT_GT(seen, 20000u);
  EXPECT_GT(culled, 20000u);
  EXPECT_GT(shared, 100u);
}

}  // namespace
}  // namespace sightline::placed
