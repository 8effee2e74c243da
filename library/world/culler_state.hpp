// What stands behind sightline::Culler.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sightline/occlusion.hpp>
#include <sightline/world.hpp>

#include "library/world/account.hpp"
#include "library/world/occluder_picks.hpp"
#include "library/world/sector_test.hpp"
#include "library/world/world_cull.hpp"
#include "library/world/world_state.hpp"

namespace sightline::world {

struct Job {
  std::size_t first_entry = 0, entries = 0;
  std::size_t first_output = 0;
  PassCounts counts;
};

/// Of several views those that differ.
struct DifferentViews {
  std::size_t count = 0;
  std::array<std::uint8_t, kMaxViews> first{};  ///< which of the caller's views
  std::array<std::uint8_t, kMaxViews> bits{};   ///< of all that are the same
};

/// What automatic occlusion remembers from frame to frame.
struct AutomaticState {
  Account account;
  ObjectCost object_cost;
  std::array<OccluderPicks, kMaxViews> picks;  ///< by the place of the caller's view
  std::vector<std::uint32_t> hidden;           ///< of PassInput
  std::vector<std::uint8_t> seen;              ///< what the triangles of each object left of its mask
  std::size_t asking = 0;                      ///< how many objects' triangles are asked, of the first
  std::uint32_t parts = 0;                     ///< in so many jobs
};

struct CullerState {
  std::vector<const ChunkMap*> maps;  ///< of the sectors that some view may see
  std::vector<WorldPoint> origins;    ///< of these
  std::vector<SectorView> views;      ///< of these
  std::vector<GroupEntry> entries;
  std::array<Job, kMaxJobs> jobs;
  /// The plane that failed last, one a view and region: the next frame tries it first.
  std::vector<std::vector<std::uint8_t>> failed;  // by the world's sector
  std::array<SectorTest, kMaxViews> tests;

  PassInput input;
  ObjectId* out = nullptr;
  std::uint8_t* masks = nullptr;
  /// Of several views that layers tell apart, where the caller wants no masks.
  std::vector<std::uint8_t> scratch_masks;

  const WorldState* world = nullptr;
  std::array<std::uint32_t, kMaxViews> layers{};  ///< of the caller's views
  bool filters_layers = false;

  AutomaticState automatic;
};

/// Writes what the input's views see of the entries, in as many jobs as there are, and adds to the result.
void run_passes(CullerState& state, const JobSystem& jobs, CullResult& result);

}  // namespace sightline::world
