// The pictures of Ye et al. 2023: figures 6, 11, 12 and 13.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "workbench/device/renderer.hpp"
#include "workbench/oracle/embree_judge.hpp"
#include "workbench/reproduce/ray_pvs/ray_pvs.hpp"

namespace sightline::reproduce {

struct RayPainter {
  device::Renderer& renderer;  ///< of the model's scene
  const oracle::EmbreeJudge& judge;
  const RayPvsOptions& options;
  int model;
};

/// Figures 11 and 12 of a model whose PVS from V is `kept`, and of model 1 figure 6.
void draw_model_pictures(const RayPainter& painter, const View& from_v, std::span<const ObjectId> kept,
                         std::vector<RayPicture>& pictures);

/// Figure 13, with the model that the renderer holds.
void draw_viewpoints_picture(device::Renderer& renderer, std::span<const RayViewpoint> viewpoints,
                             const RayPvsOptions& options, std::vector<RayPicture>& pictures);

/// From red for the least to green for the greatest, as 0 … 1 is.
std::uint32_t red_to_green(double share);

}  // namespace sightline::reproduce
