// The scene of Le Hoang Minh et al. 2022, section 4: 30,000 trees at random on one square kilometre.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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
    ParameterInfo{"ground", "squares along a side of the mesh with low hills that all stand on; 0: none", "0",
                  0, 1024, true},
};

// The layers of what stands here, a bit each.
constexpr std::uint32_t kOpaqueTrees = 1, kTransparentTrees = 2, kGround = 4;

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

// Low hills: heights at the corners of 8 × 8 patches, and between them a smooth blend, which is the same
// everywhere as it takes no more than products and sums.
class Hills {
public:
  Hills(float size, std::uint64_t seed) : size_(size) {
    Random random(seed);
    for (float& height : heights_) height = random.between(0, kHighest);
  }

  [[nodiscard]] float at(float x, float z) const noexcept {
    const auto [column, across] = place_of(x);
    const auto [row, along] = place_of(z);
    const float* corner = &heights_[row * (kPatches + 1) + column];
    const float near = corner[0] + (corner[1] - corner[0]) * across;
    const float far = corner[kPatches + 1] + (corner[kPatches + 2] - corner[kPatches + 1]) * across;
    return near + (far - near) * along;
  }

private:
  static constexpr std::size_t kPatches = 8;
  static constexpr float kHighest = 6;

  // Which patch, and how far into it, eased so that patches meet without an edge.
  [[nodiscard]] std::pair<std::size_t, float> place_of(float metres) const noexcept {
    const float patches = std::clamp((metres / size_ + 0.5f) * kPatches, 0.0f, float{kPatches});
    const std::size_t patch = std::min(static_cast<std::size_t>(patches), kPatches - 1);
    const float into = patches - static_cast<float>(patch);
    return {patch, into * into * (3 - 2 * into)};
  }

  float size_;
  std::array<float, (kPatches + 1) * (kPatches + 1)> heights_;
};

Shape ground_mesh(const Hills& hills, float size, std::uint32_t squares) {
  Shape ground;
  const float step = size / static_cast<float>(squares), half = 0.5f * size;
  for (std::uint32_t row = 0; row <= squares; ++row) {
    for (std::uint32_t column = 0; column <= squares; ++column) {
      const float x = static_cast<float>(column) * step - half, z = static_cast<float>(row) * step - half;
      ground.positions.push_back({x, hills.at(x, z), z});
    }
  }
  for (std::uint32_t row = 0; row < squares; ++row) {
    for (std::uint32_t column = 0; column < squares; ++column) {
      const std::uint32_t at = row * (squares + 1) + column, below = at + squares + 1;
      ground.indices.insert(ground.indices.end(), {at, below, at + 1, at + 1, below, below + 1});
    }
  }
  return ground;
}

Scene make_forest(const Parameters& parameters) {
  Scene scene;
  const std::uint32_t sides = parameters.count("sides");
  const auto add = [&](const Shape& shape) {
    return scene.add_mesh(shape.positions, shape.normals, shape.indices);
  };
  const std::array species{add(conifer(sides)), add(broadleaf(sides))};
  const float size = static_cast<float>(parameters.number("size")), half = 0.5f * size;
  const std::uint32_t squares = parameters.count("ground");
  // Numbers of their own: the trees stand where they stand without.
  const Hills hills(size, std::uint64_t{parameters.count("seed")} + (std::uint64_t{1} << 32));
  const auto height_at = [&](float x, float z) { return squares > 0 ? hills.at(x, z) : 0.0f; };
  const float transparent = static_cast<float>(parameters.number("transparent"));
  Random random(parameters.count("seed"));
  const std::uint32_t trees = parameters.count("trees");
  scene.bounds.reserve(trees);
  for (std::uint32_t i = 0; i < trees; ++i) {
    Vec3 at = random.inside({{-half, 0, -half}, {half, 0, half}});
    at.y += height_at(at.x, at.z);
    const float height = random.between(5, 14), heading = random.between(0, 2 * std::numbers::pi_v<float>);
    const std::uint32_t kind = random.below(2);
    const bool blended = random.unit() < transparent;
    scene.add_object(species[kind], place(at, height, heading),
                     blended ? Surface::transparent : Surface::opaque);
    scene.layers.back() = blended ? kTransparentTrees : kOpaqueTrees;
  }
  if (squares > 0) {
    scene.add_object(add(ground_mesh(hills, size, squares)), {});
    scene.layers.back() = kGround;
  }
  scene.viewpoints.push_back({"near", {0, height_at(0, 0) + kForestEyeHeight, 0}, {0, 0, -1}});
  scene.viewpoints.push_back({"far", {0, 0.5f * half, 2 * half}, {0, -0.4f, -1}});
  return scene;
}

}  // namespace

const WorldInfo kForestWorld{"forest", "trees at random on a square (Le Hoang Minh et al. 2022)",
                             kForestParameters, make_forest};

}  // namespace sightline::scene
