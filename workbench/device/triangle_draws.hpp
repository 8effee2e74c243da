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

  /// Records a cleared picture, first what is not blended, then the rest in its order. `draws` are ranges of
  /// the geometry, blended ones last.
  void draw(const Recorder& frame, std::span<const DrawCommand> draws, Submission submission);

  /// Draws ranges of opaque triangles, up to the first blended one, then tests ranges of what hides nothing
  /// against them; waits.
  struct Items {
    std::vector<ObjectId> ids;        ///< which opaque object each pixel shows, row 0 first, or kNoObject
    std::vector<std::uint32_t> seen;  ///< one an object: not 0 where one that hides nothing has a pixel
  };
  [[nodiscard]] Items items(const View& view, std::span<const DrawCommand> opaque,
                            Submission submission = Submission::calls,
                            std::span<const DrawCommand> see_through = {});

  /// Device memory taken by the triangles.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

private:
  /// Of items() alone.
  struct ItemPipelines {
    GraphicsPipeline ids, seen;
    explicit ItemPipelines(const Device& device);
  };

  void submit(const Recorder& frame, const GraphicsPipeline& pipeline, std::span<const DrawCommand> draws,
              std::size_t first, Submission submission, Sides sides = Sides::both) const;
  void copy_commands(std::span<const DrawCommand> draws);
  [[nodiscard]] std::size_t unblended_count(std::span<const DrawCommand> draws) const noexcept;

  Renderer& renderer_;
  std::vector<std::uint8_t> is_transparent_;  ///< one an object
  Sides sides_ = Sides::both;  ///< of all; both where they differ, or some are cut out: tested a fragment
  std::span<const ObjectId> objects_;
  Buffer corners_, coordinates_, indices_, commands_, seen_;
  std::optional<GraphicsPipeline> opaque_, blended_;
  std::optional<ItemPipelines> item_pipelines_;
  std::optional<Image> ids_;
};

}  // namespace sightline::device
