// The CPU's part of vertex-chunk and resident-chunk: which chunks of the ground a view needs.
#pragma once

#include <span>
#include <vector>

#include <sightline/view.hpp>

#include "library/world/chunk_walk.hpp"
#include "workbench/submission/contribution.hpp"

namespace sightline::methods {

inline constexpr ParameterInfo kRegionDepthParameter{"depth", "of the quadtree of ground regions", "3",
                                                     0,       world::ChunkMap::kMaxDepth,          true};

class GroundChunks {
public:
  GroundChunks(const Scene& scene, std::uint32_t depth);

  void update(const Scene& scene, std::span<const ObjectId> moved);
  /// Fills inside() and crossing(): the region hierarchy by frustum, its chunks by frustum and contribution.
  void select(const View& view, const submission::Contribution& contribution);

  [[nodiscard]] world::ChunkMap& map() noexcept { return map_; }
  [[nodiscard]] std::span<const std::uint32_t> inside() const noexcept { return walk_.inside; }
  [[nodiscard]] std::span<const std::uint32_t> crossing() const noexcept { return walk_.crossing; }
  /// What holds all objects.
  [[nodiscard]] const Box& extent() const noexcept { return extent_; }
  [[nodiscard]] std::uint64_t nodes_visited() const noexcept { return walk_.nodes_visited; }

private:
  Box extent_;
  world::ChunkMap map_;
  world::ChunkWalk walk_;
};

}  // namespace sightline::methods
