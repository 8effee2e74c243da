// Which objects cover a whole rectangle of pixels: those that a grid of rays as wide cannot miss.
#pragma once

#include <cstdint>
#include <vector>

#include "workbench/oracle/item_buffer.hpp"

namespace sightline::oracle {

/// One byte an object: 1 where some axis-aligned rectangle of width × height pixels shows it alone. Opaque
/// objects only, as the image holds no others.
std::vector<std::uint8_t> objects_that_cover(const ItemBuffer& image, std::uint32_t width,
                                             std::uint32_t height);

}  // namespace sightline::oracle
