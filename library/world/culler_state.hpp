// What stands behind sightline::Culler.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sightline/world.hpp>

#include "library/world/account.hpp"
#include "library/world/sector_test.hpp"
#include "library/world/shadow_casters.hpp"
#include "library/world/world_cull.hpp"
#include "library/world/world_state.hpp"

namespace sightline::world {

/// What one job takes of the passes' entries, or of instances' parts, and where in the output it writes.
struct Job {
  std::size_t first = 0, count = 0;
  std::size_t first_output = 0;
  PassCounts counts;
};

/// Shares `items` of `total` objects out among jobs of about equally many objects each; each writes to where
/// it would stand if all were visible. Returns how many jobs there are.
template <class ObjectsOf>
std::uint32_t split_jobs(std::span<Job> jobs, std::size_t items, std::size_t total, std::uint32_t threads,
                         const ObjectsOf& objects_of) {
  std::uint32_t count = 0;
  std::size_t before = 0;
  for (std::size_t i = 0; i < items; ++i) {
    if (count == 0 || (count < threads && before >= total * count / threads)) {
      jobs[count] = {i, 0, before + count * kCullPadding, {}};
      ++count;
    }
    ++jobs[count - 1].count;
    before += objects_of(i);
  }
  return count;
}

/// Of several views those that differ.
struct DifferentViews {
  std::size_t count = 0;
  std::array<std::uint8_t, kMaxViews> first{};  ///< which of the caller's views
  std::array<std::uint8_t, kMaxViews> bits{};   ///< of all that are the same
};

struct CullerState;
class OccluderPicks;

/// A zone of the caller's profiler, if there is one.
class Zone {
public:
  Zone(const CullZones& zones, const char* name) noexcept;
  ~Zone();
  Zone(const Zone&) = delete;
  Zone& operator=(const Zone&) = delete;

private:
  const CullZones& zones_;
};

/// What a culler does after its passes by frustum, whose ids and masks stand in the state's output, and
/// `result` is theirs: hides what the world's occluders hide, and adds to the result's cost, no more than the
/// account allows. A world hands it to its cullers once it has an occluder, so that who has none need not
/// link it.
class Hiding {
public:
  virtual ~Hiding() = default;
  virtual void hide(CullerState& state, std::span<const CullView> views, const DifferentViews& different,
                    const CullOptions& options, const CullCosts& costs, CullResult& result) = 0;
  /// Before a cull that may hide or not.
  virtual void forget_drawn() noexcept = 0;
  /// What was drawn since for the view at this place; null: nothing.
  [[nodiscard]] virtual const OccluderPicks* drawn(std::size_t place) const noexcept = 0;
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

  const WorldState* world = nullptr;
  CullZones zones;
  std::array<WorldPoint, kMaxViews> distance_eyes;  ///< of the caller's views that differ

  Account account;
  ObjectCost object_cost;
  std::unique_ptr<Hiding> hiding;
  std::unique_ptr<Casting> casting;
  std::unique_ptr<LevelMemory> levels;
};

/// How many objects the caller draws of `count` in the output: once in each view, where masks tell.
std::uint64_t count_drawn(CullerState& state, std::size_t count) noexcept;

/// Writes what the input's views see of the entries, in as many jobs as there are, and adds to the result.
void run_passes(CullerState& state, const JobSystem& jobs, CullResult& result);

}  // namespace sightline::world

namespace sightline {

struct Culler::State : world::CullerState {};

struct CullerAccess {
  static const world::CullerState& state(const Culler& culler) noexcept { return *culler.state_; }
};

}  // namespace sightline
