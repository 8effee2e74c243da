#include "workbench/scene/worlds.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <sightline/workbench/error.hpp>

#include "library/geometry/elementary.hpp"

namespace sightline {

namespace {

constexpr std::array kOfEveryWorld{
    ParameterInfo{"offset", "metres from 0 along x and z, where the world lies", "0", -1e9, 1e9},
};

/// A world's own parameters and those of every world.
std::vector<ParameterInfo> parameters_of(const WorldInfo& world) {
  std::vector<ParameterInfo> all(world.parameters.begin(), world.parameters.end());
  all.insert(all.end(), kOfEveryWorld.begin(), kOfEveryWorld.end());
  return all;
}

}  // namespace

std::span<const WorldInfo> worlds() noexcept {
  using namespace scene;
  static const std::array kOwn{kRegularWorld, kIrregularWorld, kForestWorld, kSoupWorld,
                               kStrataWorld,  kFoliageWorld,   kCityWorld,   kCardsWorld};
  static const auto kTables = [] {
    std::array<std::vector<ParameterInfo>, kOwn.size()> tables;
    for (std::size_t i = 0; i < kOwn.size(); ++i) tables[i] = parameters_of(kOwn[i]);
    return tables;
  }();
  static const auto kWorlds = [] {
    auto all = kOwn;
    for (std::size_t i = 0; i < kOwn.size(); ++i) all[i].parameters = kTables[i];
    return all;
  }();
  return kWorlds;
}

Scene generate_world(std::string_view specification) {
  const std::string_view name = specified_name(specification);
  std::string known;
  for (const WorldInfo& world : worlds()) {
    if (world.name == name) {
      const Parameters parameters = parse_parameters("world", specification, world.parameters);
      Scene made = world.generate(parameters);
      made.name = "world:" + std::string(specification);
      // Each world is made around 0: it is the origin that lies far away.
      made.origin = {parameters.number("offset"), 0, parameters.number("offset")};
      return made;
    }
    known.append(known.empty() ? "" : ", ").append(world.name);
  }
  throw Error("world '" + std::string(name) + "': no such world, expected one of " + known);
}

namespace scene {

Affine place(const Vec3& p, float scale, float heading) noexcept {
  const float c = scale * portable::cos(heading), s = scale * portable::sin(heading);
  return {{Vec4{c, 0, s, p.x}, Vec4{0, scale, 0, p.y}, Vec4{-s, 0, c, p.z}}};
}

}  // namespace scene
}  // namespace sightline
