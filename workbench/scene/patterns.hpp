// Alpha images of generated worlds and of tests: what a texture of leaves, bars or needles leaves open.
#pragma once

#include <sightline/workbench/scene.hpp>

namespace sightline::scene {

/// Discs of random size at random places, `side` texels square, repeating without a seam; about as much of it
/// is opaque as `share` says. Their rims fade over two texels.
AlphaImage leaves_pattern(std::uint32_t side, float share, std::uint64_t seed);

/// Bars across and up, `bar` texels of every `pitch` opaque.
AlphaImage grate_pattern(std::uint32_t side, std::uint32_t pitch, std::uint32_t bar);

}  // namespace sightline::scene
