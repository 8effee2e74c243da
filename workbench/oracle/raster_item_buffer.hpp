// The rasteriser as judge: which object owns each pixel when nothing is culled.
#pragma once

#include "workbench/device/renderer.hpp"
#include "workbench/oracle/item_buffer.hpp"

namespace sightline::oracle {

class RasterItemBuffer {
public:
  /// Shares the renderer's copy of the scene.
  explicit RasterItemBuffer(device::Renderer& renderer);

  /// Draws every object of the scene. The renderer's picture is left as it was, its depth is not. Of
  /// what hides nothing the rasteriser says that it is seen, not in how many pixels: it counts as one.
  [[nodiscard]] ItemBuffer render(const View& view);

private:
  device::Renderer& renderer_;
  device::GraphicsPipeline id_pipeline_, seen_pipeline_;
  device::DrawBuffers all_;
  device::Buffer seen_;
  std::optional<device::Image> ids_;
};

}  // namespace sightline::oracle
