#version 460
#include "workbench/device/shared.h"

#include "rays.h"
layout(local_size_x = 16, local_size_y = 16) in;

// IWCPA as it is printed: a lane a pair of ray and box, which leaves their distance, -1 for a miss.
layout(push_constant, scalar) uniform Push {
  RayBuffer rays;
  BoxSpanBuffer boxes;
  DistanceBuffer distances;  // a row of rays for each of this round's boxes
  uint ray_count, first_ray, first_box, box_end;
};

void main() {
  const uint r = first_ray + gl_GlobalInvocationID.x, row = gl_GlobalInvocationID.y, b = first_box + row;
  if (r >= ray_count || b >= box_end) return;
  const BoxSpan box = boxes.at[b];
  distances.at[row * ray_count + r] = intersect_box_flat(rays.at[r], box.low, box.high);
}
