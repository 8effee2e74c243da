#include "workbench/scene/worlds.hpp"

#include <array>
#include <cmath>

#include <sightline/workbench/error.hpp>

namespace sightline {

std::span<const WorldInfo> worlds() noexcept {
  using namespace scene;
  static const std::array kWorlds{kRegularWorld, kIrregularWorld, kForestWorld, kSoupWorld, kStrataWorld};
  return kWorlds;
}

Scene generate_world(std::string_view specification) {
  const std::string_view name = specified_name(specification);
  std::string known;
  for (const WorldInfo& world : worlds()) {
    if (world.name == name) {
      Scene made = world.generate(parse_parameters("world", specification, world.parameters));
      made.name = "world:" + std::string(specification);
      return made;
    }
    known.append(known.empty() ? "" : ", ").append(world.name);
  }
  throw Error("world '" + std::string(name) + "': no such world, expected one of " + known);
}

namespace scene {

Affine place(const Vec3& p, float scale, float heading) noexcept {
  const float c = scale * std::cos(heading), s = scale * std::sin(heading);
  return {{Vec4{c, 0, s, p.x}, Vec4{0, scale, 0, p.y}, Vec4{-s, 0, c, p.z}}};
}

}  // namespace scene
}  // namespace sightline
