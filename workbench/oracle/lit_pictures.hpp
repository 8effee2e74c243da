// The picture of a scene that a light shines on through a shadow map, on a device: what shadow caster culling
// must not change.
#pragma once

#include <span>

#include <sightline/shadows.hpp>

#include "workbench/device/renderer.hpp"

namespace sightline::oracle {

/// How a lit point looks a shadow up: it moves along its normal to the light's side, then asks the texel that
/// it falls into and `reach` more to either side.
struct ShadowLookup {
  std::uint32_t reach = 2;  ///< texels; at most 7
  float metres = 0.05f;

  /// What casters must be kept for: half a texel more to the texel's middle, and the grid of 1/256 to which
  /// rasterisers move corners.
  [[nodiscard]] ShadowFilter filter() const noexcept {
    return {static_cast<float>(reach) + 0.5f + 1 / 256.0f, metres};
  }
};

class LitPictures {
public:
  /// Shares the renderer's copy of the scene, which outlives this.
  explicit LitPictures(device::Renderer& renderer);

  /// Draws the solid objects and cut-outs that the camera sees, lit through a map of its `casters`, or of all
  /// objects. What is blended neither throws shadows nor takes any. In each pixel's alpha stands how many
  /// texels said that it is lit, so that no shadow is too faint to tell. The camera counts from the scene's
  /// origin; the shadow view is one that shadow_view() made. Throws Error for a view that does not pass
  /// check().
  [[nodiscard]] device::Picture draw(const View& camera, const WorldView& shadow, const ShadowLookup& lookup,
                                     std::span<const ObjectId> casters);
  [[nodiscard]] device::Picture draw(const View& camera, const WorldView& shadow, const ShadowLookup& lookup);

private:
  device::Picture draw_with(const View& camera, const View& shadow, const ShadowLookup& lookup,
                            device::VisibleDraws::Condition condition);
  void draw_map(const View& shadow, device::VisibleDraws::Condition condition);

  device::Renderer& renderer_;
  device::GraphicsPipeline pipeline_;
  device::DrawBuffers casters_, all_;
  device::Buffer flags_, map_, depth_;
};

}  // namespace sightline::oracle
