#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// Of what was visible last frame, what is not dropped now: nothing would be drawn where it hides others.
layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer marks;
  WordBuffer occluders;
  uint objects;
};

void main() {
  const uint object = invocation();
  if (object >= objects) return;
  const BoxData box = boxes.at[object];
  const bool kept = marks.at[object] != 0 && contributes(box.centre_radius, box.half_extent.xyz);
  occluders.at[object] = kept ? 1 : 0;
}
