#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// Of what was visible last frame, what is in view now and not too small to hide anything; nor dropped, for
// nothing would be drawn where it hides others.
layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer marks;
  WordBuffer occluders;
  uint objects;
  float least;  // px² of an occluder
};

void main() {
  const uint object = invocation();
  if (object >= objects) return;
  const vec4 sphere = boxes.at[object].centre_radius;
  const bool kept = marks.at[object] != 0 && !outside(sphere) && projected_area(sphere) >= least &&
                    contributes(sphere, boxes.at[object].half_extent.xyz);
  occluders.at[object] = kept ? 1 : 0;
}
