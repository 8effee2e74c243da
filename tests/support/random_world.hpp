// A world of objects of every kind that move, come, go and are switched off, and what each of them shows.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "support/random_shapes.hpp"
#include "support/solid_boxes.hpp"

namespace sightline::test {

/// An object, and what it shows where it stands.
struct Thing {
  scene::Shape shape;  // in its own space; empty for boxes and spheres
  std::vector<Sides> sides;
  Mat4 placement;
  std::vector<Box> boxes;
  std::vector<Sphere> spheres;
  OccluderId occluder = kNoOccluder;
  bool tells_triangles = false;

  std::vector<Corners> triangles;
  Box box{};
  bool hides = false;
  bool told = true;  // where it stands; otherwise it may be anything within its box

  // About another origin.
  void shift(const Vec3& by) {
    const Box there{along(box.min, 1, by), along(box.max, 1, by)};
    Mat4 at = placement;
    at.m[12] += by.x, at.m[13] += by.y, at.m[14] += by.z;
    stand(at);
    if (!told) box = there;
  }

  void stand(const Mat4& at) {
    const Vec3 by{at.m[12] - placement.m[12], at.m[13] - placement.m[13], at.m[14] - placement.m[14]};
    placement = at;
    triangles = placed(shape, placement);
    for (Box& b : boxes) b = {along(b.min, 1, by), along(b.max, 1, by)};
    for (Sphere& s : spheres) s.centre = along(s.centre, 1, by);
    if (shape.indices.empty() && boxes.empty() && spheres.empty()) {
      box = {along(box.min, 1, by), along(box.max, 1, by)};
      return;
    }
    box = bounds_of(triangles);
    for (const Box& b : boxes) box = geometry::united(box, b);
    for (const auto& [c, r] : spheres)
      box = geometry::united(box, {along(c, -r, {1, 1, 1}), along(c, r, {1, 1, 1})});
  }
};

/// So that a box moved by these is where its matrix puts it, to the bit.
inline float on_grid(float metres) {
  return std::round(metres * 64) / 64;
}
inline Vec3 on_grid(const Vec3& p) {
  return {on_grid(p.x), on_grid(p.y), on_grid(p.z)};
}

/// Objects that carry whatever they may, on layers and at distances of all kinds.
class RandomWorld {
public:
  explicit RandomWorld(scene::Random& random) : random_(random) {
    if (random.below(3) == 0)
      origin_ = {1e6 * random.below(20) * (random.below(2) == 0 ? 1 : 500), -100, 3200.0 * random.below(9)};
    unit_ = *world_.add_occluder(kUnitBox);
    ball_ = *world_.add_occluder({}, std::array{Sphere{{0, 0, 0}, 1}});
    if (random.below(3) == 0) add(level());
    for (std::uint32_t i = 3 + random.below(9); i > 0; --i) add(any_solid());
    for (std::uint32_t i = 20 + random.below(60); i > 0; --i) add(clutter());
  }

  // Some things move, or are switched, or go and leave their ids to others.
  void change() {
    const std::uint32_t most = random_.below(3) == 0 ? 2 : 12;
    for (std::size_t i = 0; i < things_.size(); ++i) {
      if (random_.below(most) != 0) continue;
      const std::span handle = std::span(handles_).subspan(i, 1);
      switch (random_.below(8)) {
        case 0:
          EXPECT_TRUE(world_.remove(handle));
          things_[i] = random_.below(2) == 0 ? any_solid() : clutter();
          things_[i].stand(things_[i].placement);
          EXPECT_TRUE(world_.insert(BoxView(std::span(&things_[i].box, 1), origin_), handle));
          tell(i);
          break;
        case 1:
          EXPECT_TRUE(world_.set_occluding(handle, std::array<std::uint8_t, 1>{0}));
          things_[i].hides = false;
          break;
        case 2:
          move_away(i);
          break;
        default:
          move(i);
      }
    }
  }

  // At times from within a thing, about the things' origin or another.
  [[nodiscard]] WorldView any_view(scene::Random& random) const {
    const Vec3 to_origin =
        random.below(4) == 0 ? on_grid(random.inside({{-200, -9, -200}, {200, 9, 200}})) : Vec3{};
    const WorldPoint origin{origin_.x - double{to_origin.x}, origin_.y - double{to_origin.y},
                            origin_.z - double{to_origin.z}};
    for (;;) {
      const Box& at = things_[random.below(static_cast<std::uint32_t>(things_.size()))].box;
      Camera camera;
      camera.eye = random.below(3) == 0 ? along(random.inside(at), 0.3f, random.direction())
                                        : random.inside({{-9, -9, -9}, {9, 9, 9}});
      const Vec3 to = random.inside(at);
      camera.forward = {to.x - camera.eye.x, to.y - camera.eye.y, to.z - camera.eye.z};
      if (random.below(4) == 0) camera.forward = random.direction();
      camera.eye = along(camera.eye, 1, to_origin);
      camera.up = random.direction();
      camera.vertical_fov = random.between(0.2f, 2.2f);
      camera.near_plane = std::pow(10.0f, random.between(-2, 0));
      camera.far_plane = random.below(3) == 0 ? random.between(2, 20) : 1000;
      if (random.below(4) == 0) camera.orthographic_height = random.between(2, 30);
      camera.depth = random.below(2) == 0 ? Depth::standard : Depth::reversed;
      const std::uint32_t larger = random.below(8) == 0 ? 14 : 1;
      const std::uint32_t width = larger * (32 + random.below(130)),
                          height = larger * (24 + random.below(96));
      if (const Result<View> view = make_view(camera, width, height)) return {*view, origin};
    }
  }

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const WorldPoint& origin() const { return origin_; }
  [[nodiscard]] const Thing& of(ObjectId id) const { return things_[thing_of_[id]]; }

private:
  Thing level() {
    Thing out;
    out.shape = random_.below(2) == 0 ? fine_box(kUnit, 8 + random_.below(6)) : cut_walls(random_, 6);
    if (random_.below(2) == 0)
      for (std::size_t i = 0; i < out.shape.indices.size(); i += 3)
        std::swap(out.shape.indices[i + 1], out.shape.indices[i + 2]);
    out.placement = sized(random_.between(3, 9), {});
    out.sides = {any_sides()};
    carry_all(out);
    out.hides = true;
    return out;
  }

  Thing any_solid() {
    Thing out;
    const Vec3 at = on_grid(random_.inside({{-8, -8, -8}, {8, 8, 8}}));
    switch (random_.below(6)) {
      case 0:
      case 1: {  // often a wall
        Vec3 half = random_.inside({{0.05f, 0.05f, 0.05f}, {5, 5, 5}});
        if (random_.below(2) == 0) half.x = 0.1f;
        const Vec3 low = on_grid(along(at, -1, half)), high = on_grid(along(at, 1, half));
        out.boxes = {{low, along(high, 1.0f / 64, {1, 1, 1})}};
        out.placement = filling(out.boxes[0], unit_).transform;
        if (random_.below(3) == 0) {  // and its occluder well inside
          for (const std::size_t k : {0, 5, 10}) out.placement.m[k] /= 2;
          for (const std::size_t k : {0, 5, 10}) out.placement.m[12 + k / 5] += out.placement.m[k] / 2;
        }
        out.occluder = unit_;
        break;
      }
      case 2:
        out.spheres = {{at, on_grid(random_.between(0.1f, 3))}};
        out.placement = sized(out.spheres[0].radius, at);
        out.occluder = ball_;
        break;
      case 3:  // a box that is turned
        out.shape = fine_box({{0, 0, 0}, {1, 1, 1}}, 1);
        out.placement = any_placement_at(at);
        out.sides = {Sides::front};
        out.occluder = unit_;
        break;
      default:
        out.shape = any_shape(random_);
        out.placement = any_placement_at(at);
        out.sides = {any_sides()};
        if (random_.below(3) == 0)
          for (out.sides.clear(); 3 * out.sides.size() < out.shape.indices.size();)
            out.sides.push_back(any_sides());
        random_.below(3) == 0 ? carry_made(out) : carry_all(out);
    }
    out.tells_triangles = random_.below(2) == 0;
    out.hides = true;
    return out;
  }

  Sides any_sides() { return random_.below(2) == 0 ? Sides::both : Sides::front; }

  static Mat4 sized(float size, const Vec3& at) {
    Mat4 out;
    out.m[0] = out.m[5] = out.m[10] = size;
    out.m[12] = at.x, out.m[13] = at.y, out.m[14] = at.z;
    return out;
  }

  Mat4 any_placement_at(const Vec3& at) {
    Mat4 out = any_placement(random_);
    out.m[12] = at.x, out.m[13] = at.y, out.m[14] = at.z;
    return out;
  }

  // All triangles occlude.
  void carry_all(Thing& thing) {
    Occluder occluder;
    occluder.positions = thing.shape.positions, occluder.indices = thing.shape.indices;
    occluder.sides = thing.sides;
    const Result<OccluderId> id = world_.add_occluder(occluder);
    ASSERT_TRUE(id) << id.error().message();
    thing.occluder = *id;
  }

  // What is made of them does.
  void carry_made(Thing& thing) {
    const Result<Occluder> made = make_occluder(thing.shape.positions, thing.shape.indices, thing.sides);
    ASSERT_TRUE(made) << made.error().message();
    const Result<OccluderId> id = world_.add_occluder(*made);
    ASSERT_TRUE(id) << id.error().message();
    thing.occluder = *id;
  }

  Thing clutter() {
    Thing out;
    const Vec3 at = random_.inside({{-9, -9, -9}, {9, 9, 9}});
    const float size = std::pow(10.0f, random_.between(-2, 0));
    const Vec3 half = random_.inside({{0, 0, 0}, {size, size, size}});
    const auto fine = [](const Vec3& p) { return scaled(on_grid(scaled(p, 32)), 1.0f / 32); };
    out.box = {fine(along(at, -1, half)), fine(along(at, 1, half))};
    out.told = false;
    return out;
  }

  void add(Thing&& thing) {
    thing.stand(thing.placement);
    things_.push_back(std::move(thing));
    handles_.emplace_back();
    EXPECT_TRUE(
        world_.insert(BoxView(std::span(&things_.back().box, 1), origin_), std::span(handles_).last(1)));
    tell(things_.size() - 1);
  }

  // What it carries and shows, and whom it is shown.
  void tell(std::size_t i) {
    const std::span handle = std::span(handles_).subspan(i, 1);
    if (thing_of_.size() <= handle[0].index) thing_of_.resize(handle[0].index + 1);
    thing_of_[handle[0].index] = i;
    const std::array layers{random_.below(8) == 0 ? 1u << random_.below(2) : kAllLayers};
    EXPECT_TRUE(world_.set_layers(handle, layers));
    DistanceRange range;
    if (random_.below(5) == 0) range.max = random_.between(1, 20);
    if (random_.below(5) == 0) range.min = std::min(range.max, random_.between(0, 8));
    EXPECT_TRUE(world_.set_distances(handle, std::array{range}));
    tell_place(i);
  }

  void tell_place(std::size_t i) {
    const Thing& thing = things_[i];
    const std::span handle = std::span(handles_).subspan(i, 1);
    const std::array placement{OccluderPlacement{thing.occluder, thing.placement, origin_}};
    EXPECT_TRUE(world_.set_occluders(handle, placement));
    if (thing.triangles.empty() || !thing.tells_triangles) return;
    std::vector<Vec3> corners;
    for (const Corners& t : thing.triangles) corners.insert(corners.end(), t.begin(), t.end());
    const bool front = thing.sides == std::vector{Sides::front};
    EXPECT_TRUE(world_.set_triangles(handle[0], corners, origin_, front ? Sides::front : Sides::both));
  }

  void move(std::size_t i) {
    Thing& thing = things_[i];
    const float far = std::pow(10.0f, random_.between(-2, 1));
    const Vec3 by = on_grid(around(random_, {}, far));
    thing.hides = thing.told = thing.occluder != kNoOccluder;
    thing.shift(by);
    const std::span handle = std::span(handles_).subspan(i, 1);
    EXPECT_TRUE(world_.move(handle, BoxView(std::span(&thing.box, 1), origin_)));
    tell_place(i);
  }

  // Without a word on where its occluder and its triangles are now.
  void move_away(std::size_t i) {
    Thing& thing = things_[i];
    thing.box = {along(on_grid(thing.box.min), 1, {40, 0, 0}), along(on_grid(thing.box.max), 1, {41, 1, 1})};
    thing.hides = thing.told = false;
    const std::span handle = std::span(handles_).subspan(i, 1);
    EXPECT_TRUE(world_.move(handle, BoxView(std::span(&thing.box, 1), origin_)));
  }

  scene::Random& random_;
  World world_;
  WorldPoint origin_{};
  OccluderId unit_ = kNoOccluder, ball_ = kNoOccluder;
  std::vector<Thing> things_;
  std::vector<Handle> handles_;
  std::vector<std::size_t> thing_of_;  // by id
};

}  // namespace sightline::test
