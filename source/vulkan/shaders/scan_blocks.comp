#version 460
#include "vulkan/shared.h"

#include "scan.h"
layout(local_size_x = 64) in;

// Exclusive prefix sums within blocks of slots, and each block's sum. Lanes meet at two barriers and no more,
// which are what costs on llvmpipe.
const uint kRow = 8;  // lanes, and rows of lanes
shared uint of_lane[kLanes], of_row[kRow];

void main() {
  const uint lane = gl_LocalInvocationID.x, job = gl_WorkGroupID.y, row = lane / kRow;
  const uint first = gl_WorkGroupID.x * kBlockSlots + lane * kEach, last = min(first + kEach, opaque);
  const uvec2 condition = job == 0 ? condition_of[0] : condition_of[1];
  uint met = 0;  // a bit a slot
  for (uint slot = first; slot < last; ++slot) met |= meets(slot_objects.at[slot], condition) << slot - first;
  of_lane[lane] = bitCount(met);
  barrier();
  if (lane < kRow) {
    uint sum = 0;
    for (uint i = 0; i < kRow; ++i) sum += of_lane[lane * kRow + i];
    of_row[lane] = sum;
  }
  barrier();
  uint before = 0;
  for (uint i = 0; i < row; ++i) before += of_row[i];
  for (uint i = row * kRow; i < lane; ++i) before += of_lane[i];
  for (uint slot = first; slot < last; ++slot) {
    scan.at[prefix_at(job) + slot] = before + bitCount(met & (1u << slot - first) - 1);
  }
  if (lane == kLanes - 1) scan.at[sums_at(job) + gl_WorkGroupID.x] = before + bitCount(met);
  if (lane == 0 && gl_WorkGroupID.x == 0) scan.at[done_at(job)] = 0;
}
