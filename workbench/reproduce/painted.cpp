#include "workbench/reproduce/painted.hpp"

namespace sightline::reproduce {

device::Picture painted(device::Picture picture, const oracle::ItemBuffer& items,
                        const std::vector<std::uint32_t>& colours) {
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const ObjectId object = items.ids[i];
    if (object == kNoObject) continue;
    const auto byte = [](std::uint32_t colour, int channel) { return colour >> 8 * channel & 255; };
    std::uint32_t lit = 0, out = 0xff000000u;
    for (int c = 0; c < 3; ++c) lit += byte(picture.pixels[i], c);
    for (int c = 0; c < 3; ++c) out |= byte(colours[object], c) * (400 + lit) / (400 + 3 * 255) << 8 * c;
    picture.pixels[i] = out;
  }
  return picture;
}

}  // namespace sightline::reproduce
