// Baked sets against the item buffer from random views within their cells, and against a level's own.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sightline/workbench/progress.hpp>
#include <sightline/workbench/scene.hpp>

#include "workbench/oracle/embree_judge.hpp"

namespace sightline::bake {

struct BakeLoss {
  std::size_t views = 0;
  std::uint64_t pixels = 0;  ///< that show an object
  std::uint64_t lost_pixels = 0, lost_objects = 0;
  std::uint64_t kept = 0, visible = 0;  ///< objects in the cells' sets, and truly seen; summed over the views
};

/// Random places in open cells (in a level: in open space too), any heading. The near plane lies 0.1 mm
/// before the eye: one that reaches through a wall shows what stands behind it, which is in no set by place.
/// Throws Error where no cell is open.
BakeLoss check_bake(const Scene& scene, const CellPvs& cells, const oracle::EmbreeJudge& judge,
                    std::size_t views, std::uint32_t width, std::uint32_t height, std::uint64_t seed,
                    const Progress& progress = {});

/// One open cell: what was baked, and what the level's own sets say for the clusters in the cell.
struct CellComparison {
  std::uint32_t cell = 0;
  std::size_t baked = 0, level = 0;              ///< objects
  std::vector<ObjectId> only_baked, only_level;  ///< nothing only baked beyond LevelPvs::far_plane
};

/// One row an open cell. The scene has a level.
std::vector<CellComparison> compare_with_level(const Scene& scene, const CellPvs& cells);
/// Every row, with the objects that only one of the two has.
std::string comparison_csv(const CellPvs& cells, const std::vector<CellComparison>& rows);

}  // namespace sightline::bake
