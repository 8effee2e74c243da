// What a generated city is made of: each part a mesh of unit size and a material.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/scene/turn.hpp"

namespace sightline::scene {

/// Parts stand on their foot, in the middle of x; z is where they look.
enum class CityPart : std::uint8_t {
  ground,
  tower,
  roof,       ///< a hut or a setback
  sign,       ///< a card, opaque on both sides
  awning,     ///< likewise, slanting
  balcony,    ///< a floor and a grate around it
  billboard,  ///< a card, drawn from its front alone
  lamp,
  bench,
  bin,
  shelter,  ///< of glass
  car,
  fence,     ///< a grate
  hoarding,  ///< a card, drawn from its front alone
  trunk,
  crown,  ///< crossed cards of leaves
};

/// The parts' meshes in a scene, to place.
class CityParts {
public:
  explicit CityParts(Scene& scene);
  void add(CityPart part, const Affine& place);

private:
  struct Part {
    std::uint32_t mesh;
    Material material;
  };
  Scene& scene_;
  std::vector<Part> parts_;  ///< in the order of the enumeration
};

}  // namespace sightline::scene
