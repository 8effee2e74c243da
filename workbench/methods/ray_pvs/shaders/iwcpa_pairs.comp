#version 460
#extension GL_EXT_control_flow_attributes : require
#include "workbench/device/shared.h"

#include "rays.h"
layout(local_size_x = 16, local_size_y = 16) in;

// IWCPA, tuned: every (ray, box) pair, rays along x and boxes along y of workgroups of 16 by 16; -1 for a miss.
// A lane takes eight rays and every sixteenth box of its workgroup's strip, and leaves its rays' nearest: lanes that
// met at a barrier would cost a processor without one more than the distances themselves, and a box that is read once
// serves eight rays.
layout(push_constant, scalar) uniform Push {
  RayBuffer rays;
  BoxSpanBuffer boxes;
  HitBuffer nearest;  // ray_count a row of lanes, 16 rows a row of workgroups
  uint ray_count, first_box, box_end, strip;
};

const uint kRays = 8;

void main() {
  const uint first_ray = gl_WorkGroupID.x * 16 * kRays + gl_LocalInvocationID.x;
  if (first_ray >= ray_count) return;
  RayData ray[kRays];
  Hit best[kRays];
  [[unroll]] for (uint k = 0; k < kRays; ++k) {
    ray[k] = rays.at[min(first_ray + 16 * k, ray_count - 1)];
    best[k] = Hit(kNoObject, 0);
  }
  const uint begin = first_box + gl_WorkGroupID.y * strip;
  const uint end = min(begin + strip, box_end);
  for (uint b = begin + gl_LocalInvocationID.y; b < end; b += 16) {
    const BoxSpan box = boxes.at[b];
    [[unroll]] for (uint k = 0; k < kRays; ++k) {
      const float t = intersect_box_flat(ray[k], box.low, box.high);
      // Boxes come in ascending order, so that of equally near ones the first stays.
      const bool nearer = t >= 0 && (best[k].object == kNoObject || t < best[k].distance);
      best[k].object = nearer ? b : best[k].object;
      best[k].distance = nearer ? t : best[k].distance;
    }
  }
  const uint row = (gl_WorkGroupID.y * 16 + gl_LocalInvocationID.y) * ray_count;
  [[unroll]] for (uint k = 0; k < kRays; ++k) {
    const uint r = first_ray + 16 * k;
    if (r < ray_count) nearest.at[row + r] = Hit(best[k].object, best[k].object == kNoObject ? -1.0 : best[k].distance);
  }
}
