// What grid-cell and object-frustum do with the objects that their cells leave.
#pragma once

#include <sightline/workbench/method.hpp>

#include "workbench/submission/draw_list.hpp"

namespace sightline::methods {

inline constexpr ParameterInfo kLayersParameter{
    "layers",     "a bit a layer, as a number: objects of no such layer are left out",
    "4294967295", 0,
    4294967295.0, true};

/// Leaves out objects of layers that nobody asks for (the paper's step C2), and makes draws of the rest, a
/// call a mesh or a call an object (C7).
class VisibleList {
public:
  VisibleList(const Scene& scene, const Parameters& parameters)
      : scene_(scene),
        layers_(parameters.count("layers")),
        draw_list_(scene, submission::call_from(parameters)) {}

  /// Whether some layer is not asked for, so that what is seen of it is lost.
  [[nodiscard]] bool leaves_out_layers() const noexcept { return layers_ != kAllLayers; }

  void keep_layers(Frame& frame) const noexcept {
    if (!leaves_out_layers()) return;
    std::erase_if(frame.visible, [&](ObjectId object) { return (scene_.layers[object] & layers_) == 0; });
  }

  /// Counts what is left and orders it.
  void draw(const View& view, Frame& frame) noexcept {
    frame.stats.objects = scene_.size();
    frame.stats.culled_frustum = scene_.size() - frame.visible.size() - frame.stats.culled_occlusion;
    draw_list_.build(scene_, view, frame);
  }

private:
  const Scene& scene_;
  std::uint32_t layers_;
  submission::DrawList draw_list_;
};

}  // namespace sightline::methods
