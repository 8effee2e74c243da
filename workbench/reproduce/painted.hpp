// Pictures in which every object has a colour of its own choice.
#pragma once

#include <cstdint>
#include <vector>

#include "workbench/device/frame_times.hpp"
#include "workbench/oracle/item_buffer.hpp"

namespace sightline::reproduce {

/// As ABGR, red lowest.
inline constexpr std::uint32_t kKeptColour = 0xff1a8cffu, kCulledColour = 0xffb4b0a8u;

/// The picture with every object in its colour, one an object, lighter and darker as it was lit. `items` is
/// of the same view.
device::Picture painted(device::Picture picture, const oracle::ItemBuffer& items,
                        const std::vector<std::uint32_t>& colours);

}  // namespace sightline::reproduce
