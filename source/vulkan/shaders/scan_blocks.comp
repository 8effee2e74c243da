#version 460
#include "vulkan/shared.h"

#include "scan.h"
layout(local_size_x = 256) in;

// Exclusive prefix sums within blocks of 256 slots (Hillis & Steele 1986), and each block's sum.
shared uint partial[256];

void main() {
  const uint slot = gl_GlobalInvocationID.x, lane = gl_LocalInvocationID.x;
  const uint mine = slot < opaque ? meets(slot_objects.at[slot], opaque_condition) : 0;
  partial[lane] = mine;
  barrier();
  for (uint step = 1; step < 256; step *= 2) {
    const uint before = lane >= step ? partial[lane - step] : 0;
    barrier();
    partial[lane] += before;
    barrier();
  }
  if (slot < opaque) prefix.at[slot] = partial[lane] - mine;
  if (lane == 255) sums.at[gl_WorkGroupID.x] = partial[255];
}
