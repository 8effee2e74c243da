#version 460
#include "workbench/device/shared.h"

#include "ioc.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// Last frame's visible nodes are not tested anew; what hangs below them is.
void main() {
  const uint node = invocation();
  if (node >= total) return;
  const uint parent = parents.at[node];
  const bool reached = parent == kNoParent || seen.at[parent] != 0;
  if (!reached || (node < interior && seen.at[node] != 0)) return;
  next_list.at[atomicAdd(next_test.vertex_count, kBoxVertices) / kBoxVertices] = node;
}
