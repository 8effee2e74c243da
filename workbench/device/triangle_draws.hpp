// Draws ranges of a method's own triangles, submitted in one of three ways.
#pragma once

#include <sightline/workbench/triangle_draws.hpp>

#include "workbench/device/renderer.hpp"

namespace sightline::device {

class TriangleDraws {
public:
  /// Copies the geometry to the renderer's device; the renderer outlives this. Throws Error where memory runs
  /// out.
  TriangleDraws(Renderer& renderer, const TriangleGeometry& geometry);

  /// Records a cleared picture, opaque ranges, then blended ones in their order. `draws` are ranges of the
  /// geometry, opaque ones first. Back faces are culled where the geometry wants it.
  void draw(const Recorder& frame, std::span<const DrawCommand> draws, Submission submission);

  /// Which object each pixel shows, row 0 first, when the opaque ranges of `draws` are drawn; kNoObject for
  /// none. Draws and waits.
  [[nodiscard]] std::vector<ObjectId> item_buffer(const View& view, std::span<const DrawCommand> draws,
                                                  Submission submission);

  /// Device memory taken by the triangles.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

private:
  struct Pipelines {
    GraphicsPipeline lit, blended, ids;
    Pipelines(const Device& device, bool cull_back);
  };

  void submit(const Recorder& frame, const GraphicsPipeline& pipeline, std::span<const DrawCommand> draws,
              std::size_t first, Submission submission) const;
  void copy_commands(std::span<const DrawCommand> draws);
  [[nodiscard]] std::size_t opaque_count(std::span<const DrawCommand> draws) const noexcept;

  Renderer& renderer_;
  std::vector<std::uint8_t> is_transparent_;  ///< one an object
  std::span<const ObjectId> objects_;
  Buffer corners_, indices_, commands_;
  Pipelines pipelines_;
  std::optional<Image> ids_;
};

}  // namespace sightline::device
