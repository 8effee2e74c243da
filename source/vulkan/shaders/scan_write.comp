#version 460
#include "vulkan/shared.h"

#include "scan.h"
layout(local_size_x = 256) in;

void main() {
  const uint slot = gl_GlobalInvocationID.x;
  if (slot >= opaque) return;
  const uint object = slot_objects.at[slot];
  const uint place = prefix.at[slot] + sums.at[slot / 256];
  prefix.at[slot] = place;
  if (meets(object, opaque_condition) != 0) list.at[place] = object;
}
