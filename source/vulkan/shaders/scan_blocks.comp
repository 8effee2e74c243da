#version 460
#include "vulkan/shared.h"

#include "scan.h"
layout(local_size_x = 256) in;

// Exclusive prefix sums within blocks of slots (Hillis & Steele 1986, over runs of a few slots a lane), and
// each block's sum.
shared uint partial[kLanes];

void main() {
  const uint lane = gl_LocalInvocationID.x, job = gl_WorkGroupID.y;
  const uint first = gl_WorkGroupID.x * kBlockSlots + lane * kEach, last = min(first + kEach, opaque);
  const uvec2 condition = job == 0 ? condition_of[0] : condition_of[1];
  uint mine = 0;
  for (uint slot = first; slot < last; ++slot) {
    scan.at[prefix_at(job) + slot] = mine;
    mine += meets(slot_objects.at[slot], condition);
  }
  partial[lane] = mine;
  barrier();
  for (uint step = 1; step < kLanes; step *= 2) {
    const uint before = lane >= step ? partial[lane - step] : 0;
    barrier();
    partial[lane] += before;
    barrier();
  }
  for (uint slot = first; slot < last; ++slot) scan.at[prefix_at(job) + slot] += partial[lane] - mine;
  if (lane == kLanes - 1) scan.at[sums_at(job) + gl_WorkGroupID.x] = partial[lane];
  if (lane == 0 && gl_WorkGroupID.x == 0) scan.at[done_at(job)] = 0;
}
