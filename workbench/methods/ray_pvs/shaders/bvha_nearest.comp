#version 460
#include "workbench/device/shared.h"

#include "rays.h"
layout(local_size_x = 256) in;

// The nearest of each ray's candidates.
layout(push_constant, scalar) uniform Push {
  HitBuffer distances;
  WordBuffer first;  // of each ray's candidates, and the end
  HitBuffer hits;
  WordBuffer marks;
  uint ray_count;
};

void main() {
  const uint r = gl_GlobalInvocationID.x;
  if (r >= ray_count) return;
  Hit best = Hit(kNoObject, -1);
  for (uint c = first.at[r]; c < first.at[r + 1]; ++c) offer(best, distances.at[c].distance, distances.at[c].object);
  hits.at[r] = best;
  if (best.object != kNoObject) marks.at[best.object] = 1;
}
