// Occlusion in one call: what a cull by frustum left is culled again by what the world's objects carry, as
// far as that pays.
#pragma once

#include <memory>

#include "library/world/culler_state.hpp"

namespace sightline::world {

/// For a culler's own.
std::unique_ptr<Hiding> make_hiding();

}  // namespace sightline::world
