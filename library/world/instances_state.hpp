// What stands behind sightline::Instances: a world of the instances' boxes, and what each of them shows.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

#include <sightline/instances.hpp>

#include "library/world/world_state.hpp"

namespace sightline::world {

/// What all of a world's objects lie in; or nothing.
struct WorldBounds {
  WorldBox box;
  bool empty = true;
  bool operator==(const WorldBounds&) const = default;
};
WorldBounds bounds_of(const WorldState& world) noexcept;

/// A world that instances show.
struct PlacedWorld {
  const World* world = nullptr;  ///< null: the name is free
  WorldBounds bounds;            ///< by which its instances were placed
  std::size_t instances = 0;
};

struct InstancesState {
  World boxes;  ///< of instances; what a world without objects places is a point
  std::vector<InstancePlacement> placements;  ///< one an id
  std::vector<PlacedWorld> worlds;            ///< by name
  std::vector<std::uint32_t> free_names;
};

/// The length of the transform's columns.
double scale_of(const InstancePlacement& placement) noexcept;

}  // namespace sightline::world

namespace sightline {

struct Instances::State : world::InstancesState {};

struct InstancesAccess {
  static const world::InstancesState& state(const Instances& instances) noexcept { return *instances.state_; }
};

}  // namespace sightline
