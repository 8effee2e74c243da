// The scene of Le Hoang Minh et al. 2022, section 4: 30,000 trees at random on one square kilometre.
#include <array>
#include <cmath>

#include "workbench/scene/random.hpp"
#include "workbench/scene/shapes.hpp"
#include "workbench/scene/worlds.hpp"

namespace sightline::scene {

namespace {

constexpr float kForestEyeHeight = 8.9f;  // as published

constexpr std::array kForestParameters{
    ParameterInfo{"trees", "how many", "30000", 1, 20000000, true},
    ParameterInfo{"size", "metres, the side of the square", "1000", 10, 1000000},
    ParameterInfo{"transparent", "share of trees with blended foliage", "0.2", 0, 1},
    ParameterInfo{"sides", "sides of trunk and crown", "8", 3, 64, true},
    ParameterInfo{"seed", "of the random numbers", "1", 0, 4294967295.0, true},
};

// A tree of unit height: a trunk and a crown of three stacked cones or one rounded crown.
Shape conifer(std::uint32_t sides) {
  Shape tree = cone(0.03f, 0.02f, 0, 0.2f, sides);
  for (const auto& [radius, low, high] :
       {std::array{0.22f, 0.15f, 0.5f}, {0.17f, 0.4f, 0.75f}, {0.12f, 0.62f, 1.0f}}) {
    tree.append(cone(radius, 0, low, high, sides));
    tree.append(disc(radius, low, sides, false));
  }
  return tree;
}

Shape broadleaf(std::uint32_t sides) {
  Shape tree = cone(0.035f, 0.025f, 0, 0.4f, sides);
  tree.append(disc(0.15f, 0.3f, sides, false));
  tree.append(cone(0.15f, 0.28f, 0.3f, 0.55f, sides));
  tree.append(cone(0.28f, 0.2f, 0.55f, 0.85f, sides));
  tree.append(cone(0.2f, 0, 0.85f, 1.0f, sides));
  return tree;
}

Scene make_forest(const Parameters& parameters) {
  Scene scene;
  const std::uint32_t sides = parameters.count("sides");
  const auto add = [&](const Shape& shape) {
    return scene.add_mesh(shape.positions, shape.normals, shape.indices);
  };
  const std::array species{add(conifer(sides)), add(broadleaf(sides))};
  const float half = 0.5f * static_cast<float>(parameters.number("size"));
  const float transparent = static_cast<float>(parameters.number("transparent"));
  Random random(parameters.count("seed"));
  const std::uint32_t trees = parameters.count("trees");
  scene.bounds.reserve(trees);
  for (std::uint32_t i = 0; i < trees; ++i) {
    const Vec3 at = random.inside({{-half, 0, -half}, {half, 0, half}});
    const float height = random.between(5, 14), heading = random.between(0, 2 * std::numbers::pi_v<float>);
    const std::uint32_t kind = random.below(2);
    const bool blended = random.unit() < transparent;
    scene.add_object(species[kind], place(at, height, heading),
                     blended ? Surface::transparent : Surface::opaque);
  }
  scene.viewpoints.push_back({"near", {0, kForestEyeHeight, 0}, {0, 0, -1}});
  scene.viewpoints.push_back({"far", {0, 0.5f * half, 2 * half}, {0, -0.4f, -1}});
  return scene;
}

}  // namespace

const WorldInfo kForestWorld{"forest", "trees at random on a square (Le Hoang Minh et al. 2022)",
                             kForestParameters, make_forest};

}  // namespace sightline::scene
