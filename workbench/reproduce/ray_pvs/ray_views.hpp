// The models of strata and the views of them that the reproduction of Ye et al. 2023 takes.
#pragma once

#include <sightline/view.hpp>
#include <sightline/workbench/frame.hpp>

#include "workbench/device/renderer.hpp"
#include "workbench/reproduce/ray_pvs/ray_pvs.hpp"

namespace sightline::reproduce {

Scene ray_model(int number, const RayPvsOptions& options);

/// From `eye` to the origin, where the models stand centred; from V they fill it.
View view_of_model(const Vec3& eye, const RayPvsOptions& options);

/// At the distance of V from the origin, so many degrees to the side of it and above it.
Vec3 eye_around(const Scene& scene, double aside, double above);

/// A frame of what `frame` has visible; its draws are made anew. Milliseconds.
double draw_frame(device::Renderer& renderer, const View& view, Frame& frame);

}  // namespace sightline::reproduce
