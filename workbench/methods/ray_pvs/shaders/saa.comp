#version 460
#include "workbench/device/shared.h"

#include "rays.h"
layout(local_size_x = 256) in;

// SAA, section 3.4.3: one ray a lane goes through Arr_a, the nodes depth first; a hit leads to the next node, a miss
// past the Arr_b[i] descendants. No stack.
layout(push_constant, scalar) uniform Push {
  RayBuffer rays;
  NodeBuffer nodes;
  HitBuffer hits;
  WordBuffer marks;
  uint ray_count, node_count;
};

void main() {
  const uint r = gl_GlobalInvocationID.x;
  if (r >= ray_count) return;
  const RayData ray = rays.at[r];
  Hit nearest = Hit(kNoObject, -1);
  for (uint i = 0; i < node_count;) {
    const NodeData node = nodes.at[i];
    const float t = intersect_box(ray, node.low, node.high);
    if (t < 0) {
      i += 1 + node.descendants;
      continue;
    }
    if (node.object != kNoObject) offer(nearest, t, node.object);
    ++i;
  }
  hits.at[r] = nearest;
  if (nearest.object != kNoObject) marks.at[nearest.object] = 1;
}
