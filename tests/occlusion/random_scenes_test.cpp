// Random meshes, boxes and spheres, drawn together and seen from anywhere, the near plane through them as
// often as not: each pixel and each answer is held against exact rays, and every processor draws the same
// bits.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <sightline/occlusion.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/exact_rays.hpp"
#include "support/random_shapes.hpp"

namespace sightline {
namespace {

using namespace test;
using scene::Random;
using scene::Shape;

struct Occluders {
  Shape shape;
  Mat4 placement;
  Sides sides = Sides::both;
  TJunctions junctions = TJunctions::open;
  std::vector<Corners> triangles;  // where they stand
  Vec3 middle{};
  float size = 0;
  std::vector<Box> boxes;
  std::vector<Sphere> spheres;
};

Occluders any_occluders(Random& random) {
  Occluders out;
  out.shape = any_shape(random);
  out.placement = any_placement(random);
  out.sides = random.below(2) == 0 ? Sides::both : Sides::front;
  // Rounding opens junctions of what is moved.
  const bool in_place = out.placement == Mat4{};
  if (in_place && random.below(2) == 0) out.junctions = TJunctions::closed;
  out.triangles = placed(out.shape, out.placement);
  const auto& [low, high] = bounds_of(out.triangles);
  out.middle = {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
  out.size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  const auto near = [&] { return around(random, out.middle, out.size); };
  for (std::uint32_t i = random.below(4); i > 0; --i) {
    const Vec3 at = near(), half = random.inside({{0.01f, 0.01f, 0.01f}, {0.3f, 0.3f, 0.3f}});
    out.boxes.push_back({along(at, -out.size, half), along(at, out.size, half)});
  }
  for (std::uint32_t i = random.below(3); i > 0; --i)
    out.spheres.push_back({near(), out.size * random.between(0.05f, 0.4f)});
  return out;
}

View any_view(Random& random, const Occluders& of) {
  for (;;) {
    Camera camera;
    camera.eye = around(random, of.middle, 1.5f * of.size);
    camera.forward = {of.middle.x - camera.eye.x, of.middle.y - camera.eye.y, of.middle.z - camera.eye.z};
    if (random.below(3) == 0) camera.forward = random.direction();
    camera.up = random.direction();
    camera.vertical_fov = random.between(0.2f, 2.2f);
    camera.near_plane = of.size * std::pow(10.0f, random.between(-3, -0.4f));
    camera.far_plane = 100 * of.size;
    if (random.below(3) == 0) camera.orthographic_height = of.size * random.between(0.3f, 2);
    if (random.below(4) == 0) camera.shift_x = random.between(-0.5f, 0.5f);
    camera.depth = random.below(2) == 0 ? Depth::standard : Depth::reversed;
    const std::uint32_t larger = random.below(12) == 0 ? 32 : 1;
    const std::uint32_t width = larger * (16 + random.below(48)), height = larger * (16 + random.below(32));
    if (const Result<View> view = make_view(camera, width, height)) return *view;
  }
}

std::vector<float> draw(const Occluders& of, const OccluderMesh& mesh, const View& view,
                        const OcclusionOptions& options, OcclusionBuffer& buffer) {
  EXPECT_TRUE(buffer.begin({view, {}}, options));
  EXPECT_TRUE(buffer.draw_mesh(mesh, of.placement));
  EXPECT_TRUE(buffer.draw_boxes(std::span<const Box>(of.boxes)));
  EXPECT_TRUE(buffer.draw_spheres(std::span<const Sphere>(of.spheres)));
  std::vector<float> out(std::size_t{view.width} * view.height);
  EXPECT_TRUE(buffer.read_nearness(out));
  return out;
}

// What the occluders show at places of the image.
class Truth {
public:
  Truth(const Occluders& of, const View& view) : of_(of), rays_(view) {
    for (const Corners& t : of.triangles)
      if (of.sides == Sides::both || shows_front(view, t)) shown_.push_back(t);
  }
  [[nodiscard]] double nearest(const glm::dvec2& p) const {
    double best = ExactRays::kMiss;
    for (const Corners& t : shown_) best = std::max(best, rays_.hit(p.x, p.y, t));
    for (const Box& box : of_.boxes) best = std::max(best, rays_.hit(p.x, p.y, box));
    for (const Sphere& sphere : of_.spheres) best = std::max(best, rays_.hit(p.x, p.y, sphere));
    return best;
  }
  template <class Thing>
  [[nodiscard]] double at(const glm::dvec2& p, const Thing& thing) const {
    return rays_.hit(p.x, p.y, thing);
  }

private:
  const Occluders& of_;
  ExactRays rays_;
  std::vector<Corners> shown_;
};

struct Counts {
  std::size_t drawn = 0, hidden = 0;
};

class Look {
public:
  Look(Random& random, const Occluders& of, const OccluderMesh& mesh, Counts& counts)
      : random_(random), of_(of), view_(any_view(random, of)), truth_(of, view_), counts_(counts) {
    options_.coverage = random.below(3) == 0 ? Coverage::centres : Coverage::area;
    options_.scale = 1u << random.below(3) * random.below(2);
    drawn_ = draw(of, mesh, view_, options_, buffer_);
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      OcclusionBuffer other;
      EXPECT_EQ(draw(of, mesh, view_, options_, other), drawn_) << hwy::TargetName(target);
    }
    hwy::SetSupportedTargetsForTest(0);
  }

  void hold_pixels() {
    const float none =
        is_orthographic(view_) ? static_cast<float>(ExactRays::kMiss) : 0;  // what hides nothing
    for (const std::size_t i : pixels_to_look_at()) {
      if (!(drawn_[i] > none)) continue;
      ++counts_.drawn;
      for (const glm::dvec2& p : places_in(random_, view_, i, options_.coverage))
        ASSERT_LE(drawn_[i], truth_.nearest(p)) << "at " << p.x << ' ' << p.y;
    }
  }
  // Something behind a triangle, as the eye has it.
  void hold_answers() {
    const Corners& t = of_.triangles[random_.below(static_cast<std::uint32_t>(of_.triangles.size()))];
    const float a = random_.unit(), b = random_.between(0, 1 - a),
                away = std::pow(10.0f, random_.between(-4, 0));
    const auto mix = [&](float p, float q, float r) { return p + a * (q - p) + b * (r - p); };
    const Vec3 on{mix(t[0].x, t[1].x, t[2].x), mix(t[0].y, t[1].y, t[2].y), mix(t[0].z, t[1].z, t[2].z)};
    const Vec3 eye = eye_position(view_);
    const Vec3 at = is_orthographic(view_) ? along(on, of_.size * away, view_direction(view_))
                                           : along(on, away, {on.x - eye.x, on.y - eye.y, on.z - eye.z});
    const float size = of_.size * std::pow(10.0f, random_.between(-4, -1));
    const Box box{along(at, -size, {1, 1, 1}), along(at, size, {1, 1, 1})};
    around_ = pixels_around(box);
    hold(buffer_.may_see(box), box);
    std::array<std::uint8_t, 1> seen{};
    const Sphere sphere{at, size};
    EXPECT_TRUE(buffer_.may_see(std::array{sphere}, seen));
    hold(seen[0] != 0, sphere);
    std::array<Vec3, 3> triangle;
    for (Vec3& corner : triangle) corner = along(at, size, random_.direction());
    hold(buffer_.may_see(triangle), triangle);
  }

private:
  static constexpr std::size_t kAll = 5000;

  [[nodiscard]] std::vector<std::size_t> all_pixels() const {
    std::vector<std::size_t> out(drawn_.size());
    std::iota(out.begin(), out.end(), std::size_t{0});
    return out;
  }
  // Of a large image those at the edges of triangles, and some.
  std::vector<std::size_t> pixels_to_look_at() {
    if (drawn_.size() <= kAll) return all_pixels();
    std::vector<std::size_t> out;
    for (int i = 0; i < 300; ++i) out.push_back(random_.below(static_cast<std::uint32_t>(drawn_.size())));
    for (int i = 0; i < 700; ++i) {
      const Corners& t = of_.triangles[random_.below(static_cast<std::uint32_t>(of_.triangles.size()))];
      const std::size_t k = random_.below(3);
      const double part = double{random_.unit()};
      glm::dvec2 at;
      const auto corner = [&](std::size_t of) { return geometry::to_double(t[of % 3]); };
      if (!seen_at(view_, glm::mix(corner(k), corner(k + 1), part), at)) continue;
      at += glm::dvec2(random_.between(-1, 1), random_.between(-1, 1));
      if (at.x >= 0 && at.x < view_.width && at.y >= 0 && at.y < view_.height)
        out.push_back(pixel_of(view_, at));
    }
    return out;
  }
  std::vector<std::size_t> pixels_around(const Box& box) {
    if (drawn_.size() <= kAll) return all_pixels();
    std::vector<std::size_t> out;
    for (int i = 0; i < 200; ++i) {
      glm::dvec2 at;
      if (seen_at(view_, geometry::to_double(random_.inside(box)), at)) out.push_back(pixel_of(view_, at));
    }
    return out;
  }

  template <class Thing>
  void hold(bool visible, const Thing& thing) {
    if (visible) return;
    ++counts_.hidden;
    for (const std::size_t i : around_) {
      for (const glm::dvec2& p : places_in(random_, view_, i, options_.coverage)) {
        const double at = truth_.at(p, thing);
        if (at > ExactRays::kMiss) ASSERT_GE(truth_.nearest(p), at) << "seen at " << p.x << ' ' << p.y;
      }
    }
  }

  Random& random_;
  const Occluders& of_;
  View view_;
  Truth truth_;
  Counts& counts_;
  OcclusionOptions options_;
  OcclusionBuffer buffer_;
  std::vector<float> drawn_;
  std::vector<std::size_t> around_;  // pixels that what is asked for may show in
};

TEST(RandomScenes, AreDrawnAndAnsweredAsExactRaysHaveThem) {
  Counts counts;
  const std::uint64_t scenes = for_random_scenes(100, [&](Random& random) {
    const Occluders of = any_occluders(random);
    const Result<OccluderMesh> mesh =
        OccluderMesh::make(of.shape.positions, of.shape.indices, of.sides, of.junctions);
    ASSERT_TRUE(mesh);
    for (int i = 0; i < 2; ++i) {
      Look look(random, of, *mesh, counts);
      look.hold_pixels();
      look.hold_answers();
    }
  });
  EXPECT_GT(counts.drawn, 200 * scenes);
  EXPECT_GT(2 * counts.hidden, scenes);
}

// What ends at their corners shows wherever it ends.
TEST(RandomScenes, StripsCoverNoPixelThatShowsAHole) {
  Counts counts;
  const std::uint64_t scenes = for_random_scenes(60, [&](Random& random) {
    Occluders of;
    of.shape = strips(random);
    of.sides = random.below(2) == 0 ? Sides::both : Sides::front;
    of.junctions = TJunctions::closed;
    of.triangles = placed(of.shape, of.placement);
    of.middle = {0.5f, 0.5f, 0}, of.size = 1;
    if (of.triangles.empty()) return;
    const auto mesh = OccluderMesh::make(of.shape.positions, of.shape.indices, of.sides, of.junctions);
    ASSERT_TRUE(mesh);
    for (int i = 0; i < 2; ++i) Look(random, of, *mesh, counts).hold_pixels();
  });
  EXPECT_GT(counts.drawn, 100 * scenes);
}

}  // namespace
}  // namespace sightline
