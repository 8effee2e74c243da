#version 460
#include "workbench/device/shared.h"

#include "ioc.h"
layout(local_size_x = 64) in;
#include "workbench/device/shaders/invocation.h"

// The children of nodes that turned out visible are tested next.
void main() {
  const uint count = test.vertex_count / kBoxVertices;
  for (uint i = invocation(); i < count; i += gl_NumWorkGroups.x * gl_NumWorkGroups.y * 64) {
    const uint node = list.at[i];
    if (node >= interior || marks.at[node] == 0) continue;
    const NodeData data = nodes.at[node];
    const uint place = atomicAdd(next_test.vertex_count, kBoxVertices * data.child_count) / kBoxVertices;
    for (uint c = 0; c < data.child_count; ++c) next_list.at[place + c] = children.at[data.first_child + c];
  }
}
