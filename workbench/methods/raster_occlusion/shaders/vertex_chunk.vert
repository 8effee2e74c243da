#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"

// Figure 2 of Lee & Shin 2023, vertex stage: frustum and contribution culling, one vertex an object.
layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer marks;
};

layout(location = 0) in vec3 centre;
layout(location = 1) in vec3 half_extent;
layout(location = 2) in uint object;
layout(location = 0) out vec3 box_centre;
layout(location = 1) out vec3 box_half_extent;
layout(location = 2) out flat uint box_object;
layout(location = 3) out flat uint outcome;  // 0 dropped, 1 tested, 2 marked untested

void main() {
  box_centre = centre;
  box_half_extent = widened(centre, half_extent);
  box_object = object;
  outcome = 1;
  if (outside(centre, box_half_extent)) {
    outcome = 0;
  } else if (!contributes(vec4(centre, boxes.at[object].centre_radius.w), box_half_extent)) {
    outcome = 0;
  } else if (reaches_near_plane(centre, box_half_extent)) {
    outcome = 2;
  }
}
