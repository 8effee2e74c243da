#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// Per object: bounding sphere against six planes, then contribution.
layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer marks;
  WordBuffer counters;  // culled by frustum, by contribution
  uint objects;
};

void main() {
  const uint object = invocation();
  if (object >= objects) return;
  const BoxData box = boxes.at[object];
  uint kept = 1;
  if (outside(box.centre_radius)) {
    kept = 0;
    atomicAdd(counters.at[0], 1);
  } else if (!contributes(box.centre_radius, box.half_extent.xyz)) {
    kept = 0;
    atomicAdd(counters.at[1], 1);
  }
  marks.at[object] = kept;
}
