// Random meshes, boxes and spheres, drawn together and seen from anywhere, the near plane through them as
// often as not: each pixel and each answer is held against exact rays, and every processor draws the same
// bits. SIGHTLINE_RANDOM_SCENES says how many scenes to look at, from SIGHTLINE_RANDOM_SEED on.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <sightline/occlusion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "support/exact_rays.hpp"
#include "support/occluder_meshes.hpp"

namespace sightline {
namespace {

using scene::Random;
using scene::Shape;
using test::ExactRays;

Vec3 along(const Vec3& from, float by, const Vec3& way) {
  return {from.x + by * way.x, from.y + by * way.y, from.z + by * way.z};
}

constexpr Box kUnit{{-1, -1, -1}, {1, 1, 1}};

Vec3 around(Random& random, const Vec3& middle, float farthest) {
  const Vec3 way = random.direction();
  return along(middle, random.between(0, farthest), way);
}

// A side of a box, cut in two again and again: corners lie on others' edges.
void cut_side(Random& random, const Vec3& corner, const Vec3& u, const Vec3& v, int cuts, Shape& out) {
  if (cuts == 0 || random.below(6) == 0) {
    if (random.below(30) == 0) return;  // a hole
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    const Vec3 beside = along(corner, 1, u);
    out.positions.insert(out.positions.end(), {corner, beside, along(beside, 1, v), along(corner, 1, v)});
    for (const std::uint32_t k : {0, 1, 2, 0, 2, 3}) out.indices.push_back(first + k);
    return;
  }
  const float share = random.below(5) == 0 ? random.between(0.001f, 0.02f) : random.between(0.1f, 0.9f);
  const auto part = [](const Vec3& of, float by) { return Vec3{by * of.x, by * of.y, by * of.z}; };
  const bool across = random.below(2) == 0;
  const Vec3& way = across ? u : v;
  const Vec3 less = part(way, share), rest = part(way, 1 - share);
  cut_side(random, corner, across ? less : u, across ? v : less, cuts - 1, out);
  cut_side(random, along(corner, share, way), across ? rest : u, across ? v : rest, cuts - 1, out);
}

Shape cut_walls(Random& random) {
  Shape out;
  const Vec3 x{random.between(0.5f, 3), 0, 0}, y{0, random.between(0.5f, 3), 0},
      z{0, 0, random.between(0.5f, 3)};
  const Vec3 low{-x.x / 2, -y.y / 2, -z.z / 2}, high{x.x / 2, y.y / 2, z.z / 2};
  const auto back = [](const Vec3& v) { return Vec3{-v.x, -v.y, -v.z}; };
  const int cuts = 1 + static_cast<int>(random.below(4));
  cut_side(random, low, y, x, cuts, out), cut_side(random, low, z, y, cuts, out);
  cut_side(random, low, x, z, cuts, out), cut_side(random, high, back(x), back(y), cuts, out);
  cut_side(random, high, back(y), back(z), cuts, out), cut_side(random, high, back(z), back(x), cuts, out);
  return out;
}

// Triangles about a corner each, next to flat, some of them blades.
Shape fans(Random& random) {
  Shape out;
  for (std::uint32_t fan = 1 + random.below(4); fan > 0; --fan) {
    const Vec3 centre = random.inside(kUnit);
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    out.positions.push_back(centre);
    const float uneven = random.below(2) == 0 ? 0 : std::pow(10.0f, random.between(-7, -1));
    Vec3 u = random.direction(), v = random.direction();
    for (float turn = 0; turn < 5; turn += random.below(2) == 0 ? 0.04f : random.between(0.1f, 0.9f)) {
      const Vec3 flat = along(along(centre, std::cos(turn), u), std::sin(turn), v);
      out.positions.push_back(along(flat, uneven, random.direction()));
    }
    for (std::uint32_t i = first + 1; i + 1 < out.positions.size(); ++i)
      out.indices.insert(out.indices.end(), {first, i, i + 1});
  }
  return out;
}

// Ground with steps, holes and triangles that are turned over.
Shape ground(Random& random) {
  const std::uint32_t steps = 2 + random.below(5);
  const float rise = random.below(2) == 0 ? 0.2f : random.between(0, 3);
  Shape out = test::surface(steps, steps, false, false, [&](float u, float v) {
    return Vec3{2 * u - 1, random.between(-rise, rise), 1 - 2 * v};
  });
  for (std::size_t i = 0; i < out.indices.size(); i += 3) {
    const std::uint32_t which = random.below(14);
    if (which == 0) std::swap(out.indices[i + 1], out.indices[i + 2]);
    if (which == 1) out.indices[i] = out.indices[i + 1];
  }
  return out;
}

Shape loose(Random& random) {
  const std::uint32_t corners = 4 + random.below(24), triangles = 2 + random.below(40);
  return test::loose_triangles(random, corners, triangles);
}

// Boxes that overlap, touch and share sides.
Shape boxes(Random& random) {
  Shape out;
  const auto on_grid = [](float x) { return std::round(4 * x) / 4; };
  for (std::uint32_t box = 1 + random.below(4); box > 0; --box) {
    const Vec3 at = random.inside(kUnit), size = random.inside({{0.3f, 0.3f, 0.3f}, {1, 1, 1}});
    const Vec3 low{on_grid(at.x), on_grid(at.y), on_grid(at.z)};
    out.append(
        test::fine_box({low, {low.x + on_grid(size.x), low.y + on_grid(size.y), low.z + on_grid(size.z)}},
                       1 + random.below(2)));
  }
  return out;
}

Shape any_shape(Random& random) {
  switch (random.below(6)) {
    case 0:
      return cut_walls(random);
    case 1:
      return fans(random);
    case 2:
      return ground(random);
    case 3:
      return loose(random);
    case 4:
      return boxes(random);
    default:
      return scene::sphere(1 + random.below(2));
  }
}

// Turned, stretched, mirrored and moved, if at all.
Mat4 any_placement(Random& random) {
  if (random.below(2) == 0) return {};
  const Vec3 p = random.direction(), q = random.direction();
  const glm::dvec3 x(p.x, p.y, p.z), z = glm::normalize(glm::cross(x, glm::dvec3(q.x, q.y, q.z))),
                                     y = glm::cross(z, x);
  const double sx = random.between(0.3f, 3), sy = random.between(0.3f, 3), sz = random.below(3) == 0 ? -1 : 1;
  const Vec3 to = random.inside({{-5, -5, -5}, {5, 5, 5}});
  return geometry::to_mat4(glm::dmat4(glm::dvec4(sx * x, 0), glm::dvec4(sy * y, 0), glm::dvec4(sz * z, 0),
                                      glm::dvec4(to.x, to.y, to.z, 1)));
}

using Corners = std::array<Vec3, 3>;

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
  const geometry::RowTransform rows = geometry::row_transform(out.placement);
  Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  for (std::size_t i = 0; i < out.shape.indices.size(); i += 3) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = out.shape.positions[out.shape.indices[i + k]];
      const Vec3 q = corners[k] = in_place ? p : geometry::transform_point(rows, p);
      low = {std::min(low.x, q.x), std::min(low.y, q.y), std::min(low.z, q.z)};
      high = {std::max(high.x, q.x), std::max(high.y, q.y), std::max(high.z, q.z)};
    }
    out.triangles.push_back(corners);
  }
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
    const std::uint32_t width = 16 + random.below(48), height = 16 + random.below(32);
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
    const auto& m = of.placement.m;
    const bool mirrored =
        glm::determinant(glm::dmat3(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10])) < 0;
    const glm::dvec3 eye = geometry::eye_of(view), forward = geometry::to_double(view_direction(view));
    for (const Corners& t : of.triangles) {
      const glm::dvec3 a = geometry::to_double(t[0]),
                       n = glm::cross(geometry::to_double(t[1]) - a, geometry::to_double(t[2]) - a);
      const double side = is_orthographic(view) ? -glm::dot(n, forward) : glm::dot(n, eye - a);
      if (of.sides == Sides::both || (mirrored ? side <= 0 : side >= 0)) shown_.push_back(t);
    }
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
    options_.scale = random.below(3) == 0 ? 2 : 1;
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
    for (std::size_t i = 0; i < drawn_.size(); ++i) {
      if (!(drawn_[i] > none)) continue;
      ++counts_.drawn;
      for (const glm::dvec2& p : test::places_in(random_, view_, i, options_.coverage))
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
  template <class Thing>
  void hold(bool visible, const Thing& thing) {
    if (visible) return;
    ++counts_.hidden;
    for (std::size_t i = 0; i < drawn_.size(); ++i) {
      for (const glm::dvec2& p : test::places_in(random_, view_, i, options_.coverage)) {
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
};

std::uint64_t number_in(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

TEST(RandomScenes, AreDrawnAndAnsweredAsExactRaysHaveThem) {
  const std::uint64_t scenes = number_in("SIGHTLINE_RANDOM_SCENES", 100),
                      first = number_in("SIGHTLINE_RANDOM_SEED", 1);
  Counts counts;
  for (std::uint64_t seed = first; seed < first + scenes; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Occluders of = any_occluders(random);
    const Result<OccluderMesh> mesh =
        OccluderMesh::make(of.shape.positions, of.shape.indices, of.sides, of.junctions);
    ASSERT_TRUE(mesh);
    for (int i = 0; i < 2; ++i) {
      Look look(random, of, *mesh, counts);
      look.hold_pixels();
      look.hold_answers();
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(counts.drawn, 200 * scenes);
  EXPECT_GT(2 * counts.hidden, scenes);
}

}  // namespace
}  // namespace sightline
