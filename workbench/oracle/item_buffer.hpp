// The item buffer: which object each pixel shows when everything is drawn and nothing culled.
#pragma once

#include <cstdint>
#include <vector>

#include <sightline/workbench/scene.hpp>

namespace sightline::oracle {

struct ItemBuffer {
  std::uint32_t width = 0, height = 0;
  std::uint32_t sample = 0;   ///< of each pixel, as PixelRays has it
  std::vector<ObjectId> ids;  ///< width × height, row 0 at the top: the nearest opaque object, or kNoObject
  std::vector<float> distances;  ///< metres from the near plane to what `ids` shows; +infinity for nothing
  /// One an object: pixels it is seen in. A cut-out or transparent one is seen where nothing opaque lies
  /// before it, whatever its alpha there.
  std::vector<std::uint32_t> pixels;

  [[nodiscard]] bool sees(ObjectId object) const noexcept { return pixels[object] != 0; }
  [[nodiscard]] std::size_t visible_count() const noexcept;
};

}  // namespace sightline::oracle
