// All triangles of a method that draws its own, drawn: what its frames are to be compared with.
#pragma once

#include <vector>

#include "workbench/device/triangle_draws.hpp"
#include "workbench/oracle/item_buffer.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::oracle {

class AllTriangles {
public:
  /// Copies the geometry to the device, and finds each object's triangles in it. The renderer outlives this.
  AllTriangles(device::Renderer& renderer, const TriangleGeometry& geometry);

  /// Which opaque object each pixel shows, and which others have one; those count as one pixel each.
  [[nodiscard]] ItemBuffer look(const View& view);
  /// Of opaque triangles at one depth the first drawn shows, which is another in the other order.
  enum class Order : std::uint8_t { rising, falling };
  [[nodiscard]] device::Picture picture(const View& view, Order order);

private:
  /// Every triangle once: those that are not blended in that order, then transparent ones far to near.
  std::vector<DrawCommand> everything(const View& view, Order order);

  device::Renderer& renderer_;
  device::TriangleDraws triangles_;
  submission::DrawList draw_list_;
  std::vector<std::vector<DrawCommand>> ranges_;  ///< by object
};

}  // namespace sightline::oracle
