#version 460
#include "vulkan/shared.h"

#include "boxes.h"
#include "state.h"
layout(local_size_x = 256) in;

layout(push_constant, scalar) uniform Push {
  ViewBuffer view_data;
  BoxBuffer boxes;
  WordBuffer marks, last_marks, state;
  uint objects;
};

void main() {
  const uint object = gl_GlobalInvocationID.x;
  if (object >= objects) return;
  const ViewData view = view_data.view;
  const BoxData box = boxes.at[object];
  const vec3 centre = box.centre_radius.xyz, half_extent = box.half_extent.xyz;
  uint word = 0;
  if (!outside(view, centre, half_extent) &&
      (view.contribution == 0 || contributes(view, box.centre_radius, half_extent))) {
    word = last_marks.at[object] != 0 ? kInView | kDrawnEarly : kInView;
  }
  state.at[object] = word;
  marks.at[object] = 0;
}
