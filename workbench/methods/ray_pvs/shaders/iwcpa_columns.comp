#version 460
#include "workbench/device/shared.h"

#include "rays.h"
layout(local_size_x = 256) in;

// The nearest box of each ray among its distances, and among the boxes of earlier rounds.
layout(push_constant, scalar) uniform Push {
  DistanceBuffer distances;
  HitBuffer hits;
  WordBuffer marks;
  uint ray_count, first_box, box_end, is_last;
};

void main() {
  const uint r = gl_GlobalInvocationID.x;
  if (r >= ray_count) return;
  Hit best = Hit(kNoObject, -1);
  if (first_box != 0) best = hits.at[r];
  for (uint b = first_box; b < box_end; ++b) offer(best, distances.at[(b - first_box) * ray_count + r], b);
  hits.at[r] = best;
  if (is_last != 0 && best.object != kNoObject) marks.at[best.object] = 1;
}
