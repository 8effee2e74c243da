// The rasteriser as judge: which object owns each pixel when nothing is culled.
#pragma once

#include "workbench/device/renderer.hpp"

namespace sightline::device {

struct ItemBuffer {
  std::uint32_t width = 0, height = 0;
  std::vector<ObjectId> ids;  ///< nearest opaque object of each pixel, row 0 first; kNoObject for none
  std::vector<std::uint8_t> visible;  ///< one an object: 1 where it owns a pixel, or is transparent and seen
};

class ItemBufferPass {
public:
  /// Shares the renderer's copy of the scene.
  explicit ItemBufferPass(Renderer& renderer);

  /// Draws every object of the scene. The renderer's picture is left as it was, its depth is not.
  [[nodiscard]] ItemBuffer render(const View& view);

private:
  Renderer& renderer_;
  GraphicsPipeline id_pipeline_, seen_pipeline_;
  DrawBuffers all_;
  Buffer seen_;
  std::optional<Image> ids_;
};

}  // namespace sightline::device
