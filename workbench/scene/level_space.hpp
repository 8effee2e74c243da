// Where a level is open and where it is solid, by walking its BSP tree.
#pragma once

#include <optional>
#include <vector>

#include <sightline/workbench/level_pvs.hpp>

namespace sightline::scene {

/// Metres of the segment a–b that run through solid leaves (cluster -1).
double solid_length(const LevelPvs& level, const Vec3& a, const Vec3& b);

/// Whether the point lies in a leaf that belongs to a cluster, so that a player may be there.
bool is_open(const LevelPvs& level, const Vec3& point);

/// Indices of the leaves that belong to a cluster and enclose a volume.
std::vector<std::uint32_t> open_leaves(const LevelPvs& level);

}  // namespace sightline::scene
