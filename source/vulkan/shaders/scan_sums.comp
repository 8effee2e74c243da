#version 460
#include "vulkan/shared.h"

#include "scan.h"
layout(local_size_x = 256) in;

// One group turns the blocks' sums into what stands before each block; the total ends the prefix sums.
shared uint totals[256];

void main() {
  const uint lane = gl_LocalInvocationID.x;
  const uint blocks = (opaque + 255) / 256, each = (blocks + 255) / 256;
  const uint first = lane * each, last = min(first + each, blocks);
  uint total = 0;
  for (uint i = first; i < last; ++i) total += sums.at[i];
  totals[lane] = total;
  barrier();
  for (uint step = 1; step < 256; step *= 2) {
    const uint before = lane >= step ? totals[lane - step] : 0;
    barrier();
    totals[lane] += before;
    barrier();
  }
  uint running = totals[lane] - total;
  for (uint i = first; i < last; ++i) {
    const uint here = sums.at[i];
    sums.at[i] = running;
    running += here;
  }
  if (lane == 255) prefix.at[opaque] = totals[255];
}
