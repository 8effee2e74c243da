#version 460
#include "workbench/device/shared.h"

#include "hroc.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// Every node above a visible object is to be split next frame.
void main() {
  const uint object = invocation();
  if (object >= objects || marks.at[object] == 0) return;
  uint node = parents.at[leaves.at[object]];
  while (node != kNoParent && atomicExchange(seen.at[node], 1) == 0) node = parents.at[node];
}
