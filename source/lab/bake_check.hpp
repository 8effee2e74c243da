// Baked sets against the item buffer from random views within their cells, and against a level's own.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/scene.hpp>

#include "lab/embree_judge.hpp"
#include "lab/verify.hpp"

namespace sightline::lab {

struct BakeLoss {
  std::size_t views = 0;
  std::uint64_t pixels = 0;  ///< that show an object
  std::uint64_t lost_pixels = 0, lost_objects = 0;
  std::uint64_t kept = 0, visible = 0;  ///< objects in the cells' sets, and truly seen; summed over the views
};

/// Random places in open cells (in a level: in open space too), any heading. Throws Error where no cell is
/// open.
BakeLoss check_bake(const Scene& scene, const CellPvs& cells, const EmbreeJudge& judge, std::size_t views,
                    std::uint32_t width, std::uint32_t height, std::uint64_t seed,
                    const Progress& progress = {});

/// One open cell: objects baked, objects in the union of the level's sets over places in it, and the
/// differences.
struct CellComparison {
  std::uint32_t cell = 0;
  std::uint32_t baked = 0, level = 0, only_baked = 0, only_level = 0;
};

/// The scene has a level.
std::vector<CellComparison> compare_with_level(const Scene& scene, const CellPvs& cells, std::uint64_t seed);

}  // namespace sightline::lab
