// Occlusion in one call: what a cull by frustum left is culled again by what the world's objects carry, as
// far as that pays.
#pragma once

#include <span>

#include <sightline/world.hpp>

#include "library/world/culler_state.hpp"

namespace sightline::world {

/// After the passes of a cull by frustum: `result` is theirs, and the ids and masks stand in the state's
/// output. Sets the result's costs, and spends no more than the account lets it.
void hide_automatically(CullerState& state, std::span<const CullView> views, const DifferentViews& different,
                        const CullOptions& options, CullResult& result);

}  // namespace sightline::world
