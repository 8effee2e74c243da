#version 460
#include "workbench/device/shared.h"

#include "ioc.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// A node counts as visible next frame if an object below it is.
void main() {
  const uint object = invocation();
  if (interior + object >= total || marks.at[interior + object] == 0) return;
  uint node = parents.at[interior + object];
  while (node != kNoParent && atomicExchange(seen.at[node], 1) == 0) node = parents.at[node];
}
