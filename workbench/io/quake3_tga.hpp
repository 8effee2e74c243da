// The alpha of Targa images, as id Tech 3 reads them.
#pragma once

#include <optional>

#include <sightline/workbench/scene.hpp>

#include "workbench/io/alpha_png.hpp"
#include "workbench/io/byte_reader.hpp"

namespace sightline::io::quake3 {

/// The alpha of a true-colour Targa of 32 bits, plain or run-length encoded, its rows from the bottom
/// whatever the header says; nothing where it has none. Throws Error for other kinds, damaged ones, and
/// beyond the limits of alpha_png.hpp.
std::optional<AlphaImage> read_tga_alpha(Bytes bytes, PixelBudget& budget);

}  // namespace sightline::io::quake3
