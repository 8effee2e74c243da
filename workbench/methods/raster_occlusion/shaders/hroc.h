// A binary tree of boxes, depth first: a node's first child follows it at once, and after its descendants
// comes what goes on where a ray misses it.
struct NodeData {
  vec3 low;
  uint descendants;
  vec3 high;
  uint object;  // of a leaf
};
layout(buffer_reference, scalar) readonly buffer NodeBuffer {
  NodeData at[];
};
layout(buffer_reference, scalar) buffer TestBuffer {
  uint vertex_count, instance_count, first_vertex, first_instance;  // VkDrawIndirectCommand
  uint rays, nodes;                                                 // cast, and what they looked at
};

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  NodeBuffer nodes;
  WordBuffer parents, leaves;  // by node; by object
  WordBuffer marks, seen;      // by object; by node: whether an object below it was visible last frame
  WordBuffer groups;
  TestBuffer test;
  uint total, objects;
  uint most;        // descendants of a group
  uint everywhere;  // 1: groups out of view are drawn as well
};

const uint kNoParent = 0xffffffff;
const uint kBoxVertices = 36;

vec3 centre_of(NodeData node) {
  return 0.5 * (node.low + node.high);
}

// Seen from the centre as it was rounded.
vec3 half_extent_of(NodeData node) {
  const vec3 centre = centre_of(node);
  return max(node.high - centre, centre - node.low);
}
