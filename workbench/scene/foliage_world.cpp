// Leaves, hedges and grates before boxes: cut-outs of one and of two sides, each with its pattern of alpha.
#include <array>

#include "workbench/scene/patterns.hpp"
#include "workbench/scene/shapes.hpp"
#include "workbench/scene/turn.hpp"
#include "workbench/scene/worlds.hpp"

namespace sightline::scene {

namespace {

constexpr float kGardenEyeHeight = 1.7f;

constexpr std::array kFoliageParameters{
    ParameterInfo{"plants", "crossed cards of leaves", "400", 0, 1000000, true},
    ParameterInfo{"hedges", "boxes of needles, a third of them with a solid core", "80", 0, 1000000, true},
    ParameterInfo{"grates", "upright and lying", "80", 0, 1000000, true},
    ParameterInfo{"boxes", "solid things among and behind them", "300", 1, 1000000, true},
    ParameterInfo{"size", "metres, the side of the square", "100", 10, 100000},
    ParameterInfo{"seed", "of the random numbers", "1", 0, 4294967295.0, true},
};

/// Two cards that cross at right angles.
Shape crossed_cards() {
  Shape plant = card(1, 1), across = card(1, 1);
  for (auto* vectors : {&across.positions, &across.normals}) {
    for (Vec3& v : *vectors) v = {v.z, v.y, -v.x};
  }
  plant.append(across);
  return plant;
}

/// A box of unit size on the ground with the pattern on each side, `across` times along x and z and once up.
Shape patterned_box(float across) {
  Shape out = box({{-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}});
  for (int face = 0; face < 6; ++face) {
    for (const TextureCoordinate at : {TextureCoordinate{0, 1}, {across, 1}, {across, 0}, {0, 0}})
      out.texture_coordinates.push_back(at);
  }
  return out;
}

// One draw a statement: compilers differ in which argument of a call they compute first.
class Garden {
public:
  explicit Garden(const Parameters& parameters)
      : half_(0.5f * static_cast<float>(parameters.number("size"))), random_(parameters.count("seed")) {
    leaves_ = scene_.add_alpha_image(leaves_pattern(128, 0.55f, 11));
    needles_ = scene_.add_alpha_image(leaves_pattern(64, 0.8f, 12));
    bars_ = scene_.add_alpha_image(grate_pattern(32, 16, 4));
    plant_ = add(crossed_cards());
    hedge_ = add(patterned_box(4));
    grate_ = add(card(1, 1, 4, 4));
    solid_ = add(box({{-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}}));
    scene_.add_object(add(box({{-half_, -1, -half_}, {half_, 0, half_}})), {},
                      {Surface::opaque, Sides::front});
  }

  void add_boxes(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec3 size{random_.between(0.5f, 4), random_.between(0.5f, 5), random_.between(0.5f, 4)};
      const Sides sides = random_.below(2) == 0 ? Sides::front : Sides::both;
      const Turn turn = random_turn(random_);
      scene_.add_object(solid_, placed(somewhere(), size, turn), {Surface::opaque, sides});
    }
  }
  void add_plants(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const float width = random_.between(1, 5), height = random_.between(1, 6);
      const auto cutoff = static_cast<std::uint8_t>(random_.below(2) == 0 ? 128 : 64);
      const Sides sides = some_sides();
      const Turn turn = random_turn(random_);
      scene_.add_object(plant_, placed(somewhere(), {width, height, width}, turn),
                        {Surface::cut_out, sides, leaves_, cutoff});
    }
  }
  void add_hedges(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec3 at = somewhere(), size{random_.between(3, 10), random_.between(1, 2.5f), 0.8f};
      const Turn turn = random_turn(random_);
      scene_.add_object(hedge_, placed(at, size, turn), {Surface::cut_out, some_sides(), needles_});
      if (random_.below(3) != 0) continue;
      scene_.add_object(solid_, placed(at, {0.9f * size.x, 0.8f * size.y, 0.4f}, turn),
                        {Surface::opaque, Sides::front});
    }
  }
  void add_grates(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec3 at = somewhere();
      const float width = random_.between(1, 4), height = random_.between(1, 3);
      Affine place = placed(at, {width, height, 1}, random_turn(random_));
      if (random_.below(4) == 0)
        place = {{Vec4{width, 0, 0, at.x}, Vec4{0, 0, 1, 0.3f}, Vec4{0, -height, 0, at.z}}};
      scene_.add_object(grate_, place, {Surface::cut_out, some_sides(), bars_});
    }
  }
  Scene finish() {
    const float h = half_;
    scene_.viewpoints.push_back({"among the leaves", {0, kGardenEyeHeight, 0}, {0, 0, -1}});
    scene_.viewpoints.push_back({"from the corner", {-0.9f * h, kGardenEyeHeight, 0.9f * h}, {1, 0, -1}});
    scene_.viewpoints.push_back({"from above", {0, h, 1.2f * h}, {0, -0.8f, -1}});
    return std::move(scene_);
  }

private:
  std::uint32_t add(const Shape& shape) {
    return scene_.add_mesh(shape.positions, shape.normals, shape.indices, shape.texture_coordinates);
  }
  Vec3 somewhere() { return random_.inside({{-half_, 0, -half_}, {half_, 0, half_}}); }
  Sides some_sides() { return random_.below(3) == 0 ? Sides::front : Sides::both; }

  Scene scene_;
  float half_;
  Random random_;
  std::uint32_t leaves_, needles_, bars_, plant_, hedge_, grate_, solid_;
};

Scene make_foliage(const Parameters& parameters) {
  Garden garden(parameters);
  garden.add_boxes(parameters.count("boxes"));
  garden.add_plants(parameters.count("plants"));
  garden.add_hedges(parameters.count("hedges"));
  garden.add_grates(parameters.count("grates"));
  return garden.finish();
}

}  // namespace

const WorldInfo kFoliageWorld{"foliage",
                              "cut-out leaves, hedges and grates before boxes, of one and of two sides",
                              kFoliageParameters, make_foliage};

}  // namespace sightline::scene
