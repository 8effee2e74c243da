#version 460
#include "workbench/device/shared.h"

#include "rays.h"
layout(local_size_x = 256) in;

// BVHA: the distances of the candidates that the CPU collected, one a lane.
layout(push_constant, scalar) uniform Push {
  RayBuffer rays;
  BoxSpanBuffer boxes;
  WordBuffer candidates;      // objects
  WordBuffer candidate_rays;  // whose they are
  HitBuffer distances;
  uint count;
};

void main() {
  // Groups beyond the first 65,535 lie in further rows.
  const uint c = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 256 + gl_LocalInvocationID.x;
  if (c >= count) return;
  const uint object = candidates.at[c];
  distances.at[c] =
      Hit(object, intersect_box(rays.at[candidate_rays.at[c]], boxes.at[object].low, boxes.at[object].high));
}
