// Verification on a device: nothing lost against the rasteriser's item buffer, and the same picture to the
// bit.
#pragma once

#include "workbench/measure/verify.hpp"
#include "workbench/measure/workbench.hpp"

namespace sightline::measure {

struct DeviceVerification : Verification {
  std::vector<std::uint64_t>
      different_pixels;  ///< one a method: pixels that differ from the picture of all it could draw
  [[nodiscard]] bool passed() const noexcept;
};

/// Every random view is a camera cut for every method; after it, each view is drawn once more, so that a
/// settled frame is examined too. `moving` is the share of objects that move before every frame. Methods that
/// are not exact (CPU methods draw in an order of their own) are judged by their visible set alone.
DeviceVerification verify_on_device(Workbench& bench, std::span<const Camera> cameras, std::uint32_t width,
                                    std::uint32_t height, double moving, const Progress& progress = {});

}  // namespace sightline::measure
