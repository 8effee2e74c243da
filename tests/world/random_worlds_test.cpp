// Random worlds whose objects carry whatever they may, move, come, go and are switched off, culled with
// automatic occlusion by several views at once: what is left out is held against exact rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "support/exact_rays.hpp"
#include "support/random_world.hpp"
#include "support/run_threads.hpp"

namespace sightline {
namespace {

using namespace test;
using scene::Random;

// What a view sees by its frustum, about the view's origin, and what of that hides what.
class Truth {
public:
  Truth(const RandomWorld& world, const WorldView& view, std::span<const ObjectId> in_view)
      : view_(view.view), rays_(view.view) {
    const WorldPoint &from = world.origin(), &to = view.origin;
    const Vec3 by{static_cast<float>(from.x - to.x), static_cast<float>(from.y - to.y),
                  static_cast<float>(from.z - to.z)};
    for (const ObjectId id : in_view) things_.emplace(id, world.of(id)).first->second.shift(by);
  }
  [[nodiscard]] const Thing& of(ObjectId id) const { return things_.at(id); }

  [[nodiscard]] double hit(const glm::dvec2& p, const Thing& thing) const {
    if (!thing.told) return in_depth(rays_.hit(p.x, p.y, thing.box));
    if (rays_.hit(p.x, p.y, grown(thing.box)) == ExactRays::kMiss) return ExactRays::kMiss;
    double best = ExactRays::kMiss;
    for (std::size_t t = 0; t < thing.triangles.size(); ++t)
      if (shows(thing, t)) best = std::max(best, rays_.hit(p.x, p.y, thing.triangles[t]));
    for (const Box& box : thing.boxes) best = std::max(best, rays_.hit(p.x, p.y, box));
    for (const Sphere& sphere : thing.spheres) best = std::max(best, rays_.hit(p.x, p.y, sphere));
    return in_depth(best);
  }
  [[nodiscard]] double nearest_but(const glm::dvec2& p, ObjectId self) const {
    double best = ExactRays::kMiss;
    for (const auto& [id, thing] : things_)
      if (id != self && thing.hides) best = std::max(best, hit(p, thing));
    return best;
  }
  // Somewhere on it, in pixels; false where that is not on the image.
  [[nodiscard]] bool somewhere(Random& random, const Thing& thing, glm::dvec2& out) const {
    glm::dvec3 at = geometry::to_double(random.inside(thing.box));
    if (thing.told && !thing.triangles.empty()) {
      const auto& t = thing.triangles[random.below(static_cast<std::uint32_t>(thing.triangles.size()))];
      const double a = random.below(3) == 0 ? 1e-3 : random.unit(), b = random.between(0, 1) * (1 - a);
      at = geometry::to_double(t[0]) * (1 - a - b) + geometry::to_double(t[1]) * a +
           geometry::to_double(t[2]) * b;
    }
    return seen_at(view_, at, out);
  }

private:
  // So that what lies in the box's own surface is within.
  static Box grown(const Box& box) {
    return {along(box.min, -1e-3f, {1, 1, 1}), along(box.max, 1e-3f, {1, 1, 1})};
  }
  [[nodiscard]] bool shows(const Thing& thing, std::size_t triangle) const {
    const Sides sides = thing.sides[thing.sides.size() == 1 ? 0 : triangle];
    return sides == Sides::both || shows_front(view_, thing.triangles[triangle]);
  }
  // Nothing is seen behind the far plane.
  [[nodiscard]] double in_depth(double hit) const {
    if (hit == ExactRays::kMiss) return hit;
    const double metres = is_orthographic(view_) ? -hit : 1 / hit;
    const glm::dvec4 clip = geometry::to_double(view_.eye_to_clip) * glm::dvec4(0, 0, -metres, 1);
    return clip.z >= 0 && clip.z <= clip.w ? hit : ExactRays::kMiss;
  }

  View view_;
  ExactRays rays_;
  std::map<ObjectId, Thing> things_;
};

struct Counts {
  std::size_t in_view = 0, hidden = 0;
};

// One frame of some cameras, and at times of a light.
class Frame {
public:
  Frame(Random& random, const RandomWorld& world, std::size_t cameras) : random_(random), world_(world) {
    options_ = automatic(std::pow(10.0f, random.between(3, 7)));
    options_.buffer.coverage = random.below(3) == 0 ? Coverage::centres : Coverage::area;
    options_.buffer.scale = 1u << random.below(3) * random.below(2);
    for (std::size_t v = 0; v < cameras; ++v) {
      CullView view{.view = world.any_view(random)};
      if (random.below(4) == 0) view.layers = 1;
      if (random.below(6) == 0) view.min_area = random.between(0, 60);
      if (random.below(6) == 0) view.distance_scale = random.between(0.5f, 2);
      if (random.below(6) == 0) view.distance_view = 0;
      views_.push_back(view);
    }
    if (random.below(3) == 0) add_shadow_map();
  }

  void hold(Culler& culler, Culler& threaded, Counts& counts) {
    const Culled left = cull_with(culler, world_.world(), views_, options_, true);
    CullOptions in_jobs = options_;
    in_jobs.jobs = {run_threads, nullptr, 3};
    const Culled same = cull_with(threaded, world_.world(), views_, in_jobs, true);
    ASSERT_EQ(same.ids, left.ids);
    ASSERT_EQ(same.masks, left.masks);
    Culler plain;
    const Culled asked = cull_with(plain, world_.world(), views_, {}, true);
    // What throws no shadow on what is seen may still hide what does.
    std::vector<CullView> all_views = views_;
    for (CullView& view : all_views) view.casters = nullptr;
    const Culled all = cull_with(plain, world_.world(), all_views, {}, true);
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const std::vector<ObjectId> kept = seen_by(left, v);
      const Truth truth(world_, views_[v].view, seen_by(all, v));
      for (const ObjectId id : seen_by(asked, v)) {
        ++counts.in_view;
        if (std::binary_search(kept.begin(), kept.end(), id)) continue;
        ++counts.hidden;
        hold_hidden(truth, v, id);
        if (testing::Test::HasFailure()) return;
      }
    }
  }

private:
  void add_shadow_map() {
    Light light;
    light.kind = static_cast<LightKind>(random_.below(3));
    light.direction = random_.direction();
    const WorldPoint& o = views_[0].view.origin;
    const Vec3 at = random_.inside({{-9, -9, -9}, {9, 9, 9}});
    light.position = {o.x + double{at.x}, o.y + double{at.y}, o.z + double{at.z}};
    light.range = random_.between(5, 40), light.reach = random_.between(5, 40);
    const DepthRange depths{0, random_.between(5, 40)};
    const std::uint32_t face = light.kind == LightKind::point ? random_.below(6) : 0;
    const auto map = shadow_view(light, views_[0].view, depths, 32 + random_.below(100), face);
    if (!map || !casters_.begin(*map, views_[0].view, depths)) return;
    views_.push_back({.view = *map, .distance_view = 0, .casters = &casters_});
  }

  static std::vector<ObjectId> seen_by(const Culled& culled, std::size_t v) {
    std::vector<ObjectId> out;
    for (std::size_t i = 0; i < culled.ids.size(); ++i)
      if (culled.masks[i] >> v & 1) out.push_back(culled.ids[i]);
    std::sort(out.begin(), out.end());
    return out;
  }

  void hold_hidden(const Truth& truth, std::size_t v, ObjectId id) {
    const View& view = views_[v].view.view;
    const Thing& thing = truth.of(id);
    for (int i = 0; i < 12; ++i) {
      glm::dvec2 on;
      if (!truth.somewhere(random_, thing, on)) continue;
      std::vector<glm::dvec2> places = places_in(random_, view, pixel_of(view, on), options_.buffer.coverage);
      if (options_.buffer.coverage == Coverage::area) places.resize(2), places.push_back(on);
      for (const glm::dvec2& p : places) {
        const double at = truth.hit(p, thing);
        if (at > ExactRays::kMiss)
          ASSERT_GE(truth.nearest_but(p, id), at)
              << "object " << id << " of view " << v << " at " << p.x << ' ' << p.y;
      }
    }
  }

  Random& random_;
  const RandomWorld& world_;
  CullOptions options_;
  std::vector<CullView> views_;
  ShadowCasters casters_;
};

TEST(RandomWorlds, LoseNothingThatExactRaysMeet) {
  Counts counts;
  for_random_scenes(40, [&](Random& random) {
    RandomWorld world(random);
    Culler culler, threaded;
    const std::size_t cameras = 1 + random.below(3);
    for (int i = 0; i < 5 && !HasFailure(); ++i) {
      Frame frame(random, world, cameras);
      // The second time with what the first one learned.
      frame.hold(culler, threaded, counts), frame.hold(culler, threaded, counts);
      world.change();
    }
  });
  EXPECT_GT(8 * counts.hidden, counts.in_view);
}

}  // namespace
}  // namespace sightline
