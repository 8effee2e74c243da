#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "hroc.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// A coarse group is the largest subtree without an object that was visible last frame; those objects are
// groups by themselves. Each node knows by itself and its parent whether it is one, so all are found at once.
bool may_be_group(uint index, NodeData node) {
  if (node.descendants == 0) return true;
  if (node.descendants > most || seen.at[index] != 0) return false;
  const vec3 centre = centre_of(node);
  return !reaches_near_plane(centre, widened(centre, half_extent_of(node)));
}

void main() {
  const uint index = invocation();
  if (index >= total) return;
  const NodeData node = nodes.at[index];
  if (!may_be_group(index, node)) return;
  const uint parent = parents.at[index];
  if (parent != kNoParent && may_be_group(parent, nodes.at[parent])) return;
  const vec3 centre = centre_of(node);
  if (everywhere == 0 && outside(centre, widened(centre, half_extent_of(node)))) return;
  groups.at[atomicAdd(test.vertex_count, kBoxVertices) / kBoxVertices] = index;
}
