// The generated worlds, one file a family; worlds.cpp holds the table.
#pragma once

#include <sightline/workbench/worlds.hpp>

namespace sightline::scene {

extern const WorldInfo kRegularWorld;
extern const WorldInfo kIrregularWorld;
extern const WorldInfo kForestWorld;
extern const WorldInfo kSoupWorld;
extern const WorldInfo kStrataWorld;
extern const WorldInfo kFoliageWorld;
extern const WorldInfo kCityWorld;
extern const WorldInfo kCardsWorld;

/// A transform that scales, turns about y, and moves.
Affine place(const Vec3& position, float scale, float heading = 0) noexcept;

}  // namespace sightline::scene
