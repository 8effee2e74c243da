// Which bands of the image jobs draw of a mesh: such as cost alike, by what it cost when it looked much the
// same.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/jobs.hpp>

namespace sightline::occlusion {

struct DepthTiles;
struct MeshScratch;
struct OccluderTopology;

/// Whether jobs share a mesh out by what it cost; not where each byte of code is loaded by whoever opens a
/// web page, and there are no threads.
#ifdef __wasm__
inline constexpr bool kSharesByCost = false;
#else
inline constexpr bool kSharesByCost = true;
#endif

/// Of each row of tiles, and of one after the last, what it cost a job more than the row above it, in tiles
/// that were looked at.
using CostSteps = std::vector<std::int64_t>;
/// Where bands begin, and where the last one ends, in rows of tiles: a band a job.
using BandCuts = std::array<std::uint32_t, kMaxJobs + 1>;

/// What a mesh cost when jobs drew it.
struct DrawnMesh {
  const OccluderTopology* mesh = nullptr;  ///< only compared
  glm::dvec3 eye{}, direction{};           ///< in the mesh's space
  std::vector<std::int64_t> costs;         ///< one a row of tiles; of other images: not known

  /// Bands that would have cost the same; of the same height where nothing is known.
  [[nodiscard]] BandCuts cuts(std::uint32_t rows, std::uint32_t count) const noexcept;
  /// What each row cost, by what the jobs noted.
  void note(std::span<const MeshScratch> drawn, std::uint32_t rows);
};

/// Of the meshes that jobs drew last into a buffer, what they cost.
class BandHistory {
public:
  /// The one that looked much alike, or one of which nothing is known. `tiles` are in the mesh's space.
  DrawnMesh& find(const DepthTiles& tiles, const OccluderTopology& mesh);

private:
  std::array<DrawnMesh, kSharesByCost ? 8 : 1> drawn_;
  std::size_t oldest_ = 0;
};

}  // namespace sightline::occlusion
