#version 460
#include "scan.h"
#include "vulkan/shared.h"
layout(local_size_x = 256) in;

void main() {
  const uint slot = gl_GlobalInvocationID.x;
  if (slot >= opaque) return;
  const uint object = slot_objects.at[slot];
  const uint place = prefix.at[slot] + sums.at[slot / 256];
  prefix.at[slot] = place;
  if (listed(object) != 0) list.at[place] = object;
}
