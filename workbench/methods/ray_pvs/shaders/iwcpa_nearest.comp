#version 460
#include "workbench/device/shared.h"

#include "rays.h"
layout(local_size_x = 256) in;

// the nearest of a ray over all rows of lanes, and over the boxes of earlier rounds.
layout(push_constant, scalar) uniform Push {
  HitBuffer nearest;
  HitBuffer hits;
  WordBuffer marks;
  uint ray_count, rows, is_first, is_last;
};

void main() {
  const uint r = gl_GlobalInvocationID.x;
  if (r >= ray_count) return;
  Hit best = Hit(kNoObject, -1);
  if (is_first == 0) best = hits.at[r];
  for (uint row = 0; row < rows; ++row) {
    const Hit hit = nearest.at[row * ray_count + r];
    offer(best, hit.distance, hit.object);
  }
  hits.at[r] = best;
  if (is_last != 0 && best.object != kNoObject) marks.at[best.object] = 1;
}
