// Boxes of every form become minima and maxima about an origin, a block at a time; where kEveryFormIsQuick.
#pragma once

#include <array>
#include <cstddef>

#include "library/geometry/box_reader.hpp"

namespace sightline::geometry {

/// A block's numbers as they were given: minima and maxima, or centres and half sizes, an array a coordinate.
template <class Number>
struct GivenBlock {
  alignas(64) std::array<std::array<Number, kBlock>, 6> values;
};

/// What they mean, and about which origin they are asked for.
struct BlockForm {
  bool centred = false;
  WorldPoint from, to;
};

/// The first `count` boxes of a block about the origin asked for, rounded outwards: the same as
/// relative_box() of what BoxReader::read() says, but that numbers about one origin are not moved there and
/// back. Where half sizes are negative or no numbers, neither are minima and maxima.
void lay_out(const GivenBlock<float>& given, const BlockForm& form, std::size_t count,
             BoxBlock& out) noexcept;
void lay_out(const GivenBlock<double>& given, const BlockForm& form, std::size_t count,
             BoxBlock& out) noexcept;

}  // namespace sightline::geometry
