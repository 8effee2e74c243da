// What stands behind sightline::InstanceCuller.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "library/world/culler_state.hpp"
#include "library/world/instances_state.hpp"

namespace sightline::world {

/// What one pass writes: what is seen of an instance, or all of a world for instances that are seen whole.
struct InstancePart {
  const WorldState* world = nullptr;
  std::size_t first_sector = 0, sectors = 0;  ///< of the passes' maps
  std::size_t first_entry = 0,
              entries = 0;  ///< of the passes' entries, whose sectors count from first_sector
  std::size_t most = 0;     ///< objects of the entries' groups
  std::uint8_t views = 0;   ///< that see a whole world, a bit each; 0 where masks are not wanted
  std::uint32_t next_whole = ChunkMap::kNone;  ///< another part that is all of this world
  float scale = 1;                             ///< the instance's
  std::size_t first = 0, count = 0;            ///< what was written, of the result
};

/// An instance of which something may be seen.
struct SeenInstance {
  ObjectId instance = kNoObject;
  std::uint32_t part = 0;
};

struct InstanceCullerState {
  Culler outer;  ///< of the instances' boxes
  std::vector<ObjectId> instances;
  std::vector<std::uint8_t> instance_views;

  CullerState inner;                 ///< its maps, views and entries, of all parts one after another
  std::vector<std::uint8_t> failed;  ///< as CullerState has it, for whichever sector is walked
  std::vector<InstancePart> parts;
  std::vector<SeenInstance> seen;
  std::vector<std::uint32_t> whole;  ///< one a world: the part that is all of it, or kNone
  std::array<Job, kMaxJobs> jobs;    ///< of parts

  std::span<const CullView> views;
  const InstanceCullOptions* options = nullptr;
  std::array<Frustum, kMaxViews> frustums;  ///< about the views' origins
  LevelScale levels_by;                     ///< where levels are wanted
  std::uint64_t nodes_visited = 0;

  std::vector<InstanceRange> ranges;
  std::vector<std::uint32_t> ids;
  std::vector<std::uint8_t> masks, levels, fades;
};

/// Adds the parts of instance `id`, which `by` may see, a bit each.
void find_part(InstanceCullerState& state, const InstancesState& instances, ObjectId id, std::uint8_t by);

}  // namespace sightline::world
