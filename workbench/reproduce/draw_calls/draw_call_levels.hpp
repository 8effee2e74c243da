// The three levels that stand in for the paper's, which are not free.
#pragma once

#include <array>

namespace sightline::reproduce {

struct LevelChoice {
  const char *specification, *kind;
};

/// Of the levels of openarena-081-maps with at least so many triangles (as many as an octree of height 4, the
/// paper's best, may have cells), by their number of triangles: first decile, median and ninth decile.
inline constexpr std::size_t kLeastLevelTriangles = 4096;
inline constexpr std::array kDrawCallLevels{
    LevelChoice{"pak1-maps.pk3:maps/ce1m7.bsp", "small, in doors"},
    LevelChoice{"pak1-maps.pk3:maps/wrackdm17.bsp", "middle, out of doors"},
    LevelChoice{"pak1-maps.pk3:maps/ctf_inyard.bsp", "large, in and out of doors"},
};

}  // namespace sightline::reproduce
