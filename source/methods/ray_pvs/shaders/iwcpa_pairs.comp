#version 460
#include "vulkan/shared.h"

#include "rays.h"
layout(local_size_x = 16, local_size_y = 16) in;

// IWCPA, section 3.4: every (ray, box) pair at once, 16 rays by 16 boxes a workgroup; -1 for a miss. Each workgroup
// leaves its rays' nearest of its boxes.
layout(push_constant, scalar) uniform Push {
  RayBuffer rays;
  BoxSpanBuffer boxes;
  HitBuffer nearest;  // ray_count a row of workgroups
  uint ray_count, first_box, box_end;
};

shared float distances[16][16];  // box, ray

void main() {
  const uint r = gl_GlobalInvocationID.x, b = first_box + gl_GlobalInvocationID.y;
  const uint ray_lane = gl_LocalInvocationID.x, box_lane = gl_LocalInvocationID.y;
  float t = -1;
  if (r < ray_count && b < box_end) t = intersect_box(rays.at[r], boxes.at[b].low, boxes.at[b].high);
  distances[box_lane][ray_lane] = t;
  barrier();
  if (box_lane != 0 || r >= ray_count) return;
  Hit best = Hit(kNoObject, -1);
  for (uint i = 0; i < 16; ++i) offer(best, distances[i][ray_lane], b + i);
  nearest.at[gl_WorkGroupID.y * ray_count + r] = best;
}
