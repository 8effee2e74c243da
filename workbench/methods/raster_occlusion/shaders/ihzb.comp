#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "pyramid_test.h"
#include "tree.h"
layout(local_size_x = 64) in;
#include "workbench/device/shaders/invocation.h"

// One level, a lane a node: of nodes in view that hierarchical z leaves open the children go on to the next
// level, and objects to the raster test.
struct Level {
  uvec3 groups;  // VkDispatchIndirectCommand
  uint count;
};
layout(buffer_reference, scalar) buffer LevelBuffer {
  Level at[];
};

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  NodeBuffer nodes;
  WordBuffer children, list, next_list;
  LevelBuffer levels;
  WordBuffer fine;
  TestBuffer test;
  FloatBuffer pyramid;
  uint interior, level, widest;  // widest: workgroups that fit side by side
};

// Has the next level's dispatch look at nodes from `place` on, as many as a node has children.
void add_groups(uint place, uint count) {
  const uint group = (place + 63) / 64;
  if (group * 64 >= place + count) return;
  if (group < widest) {
    atomicAdd(levels.at[level + 1].groups.x, 1);
  } else if (group % widest == 0) {
    atomicAdd(levels.at[level + 1].groups.y, 1);
  }
}

void main() {
  if (invocation() >= levels.at[level].count) return;
  const uint node = list.at[invocation()];
  const BoxData box = boxes.at[node];
  const vec3 centre = box.centre_radius.xyz;
  const vec3 half_extent = widened(centre, box.half_extent.xyz);
  if (outside(centre, half_extent)) return;
  if (SIGHTLINE_MUTANT(ihzb_by_frustum) ? false : !leaves_open(pyramid, centre, half_extent)) return;
  if (node >= interior) {
    fine.at[atomicAdd(test.vertex_count, kBoxVertices) / kBoxVertices] = node - interior;
    return;
  }
  const NodeData data = nodes.at[node];
  const uint place = atomicAdd(levels.at[level + 1].count, data.child_count);
  add_groups(place, data.child_count);
  for (uint c = 0; c < data.child_count; ++c) next_list.at[place + c] = children.at[data.first_child + c];
}
