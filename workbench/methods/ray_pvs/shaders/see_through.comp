#version 460
#include "workbench/device/shared.h"

#include "rays.h"
layout(local_size_x = 256) in;

// Marks what hides nothing and lies on a ray before what stops it, by the tree laid flat; and hands the marks of
// what stops rays, which bear numbers of their own, to the objects.
layout(push_constant, scalar) uniform Push {
  RayBuffer rays;
  NodeBuffer nodes;
  HitBuffer hits;
  WordBuffer slot_objects, slot_marks, marks;
  uint ray_count, node_count, slot_count;
};

void main() {
  const uint r = gl_GlobalInvocationID.x;
  for (uint slot = r; slot < slot_count; slot += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
    if (slot_marks.at[slot] != 0) marks.at[slot_objects.at[slot]] = 1;
  }
  if (r >= ray_count) return;
  const RayData ray = rays.at[r];
  const Hit hit = hits.at[r];
  for (uint i = 0; i < node_count;) {
    const NodeData node = nodes.at[i];
    const float t = intersect_box(ray, node.low, node.high);
    if (t < 0 || (hit.object != kNoObject && t > hit.distance)) {
      i += 1 + node.descendants;
      continue;
    }
    if (node.object != kNoObject) marks.at[node.object] = 1;
    ++i;
  }
}
