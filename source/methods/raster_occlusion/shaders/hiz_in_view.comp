#version 460
#include "vulkan/shared.h"

#include "vulkan/shaders/view.h"

#include "boxes.h"
#include "state.h"
layout(local_size_x = 256) in;

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer marks, state;
  uint objects, frame;
};

void main() {
  const uint object = gl_GlobalInvocationID.x;
  if (object >= objects) return;
  const BoxData box = boxes.at[object];
  const vec3 centre = box.centre_radius.xyz, half_extent = box.half_extent.xyz;
  uint bits = 0;
  if (!outside(centre, half_extent) && contributes(box.centre_radius, half_extent)) {
    bits = marks.at[object] == frame - 1 ? kInView | kDrawnEarly : kInView;
  }
  state.at[object] = state_word(frame, bits);
}
