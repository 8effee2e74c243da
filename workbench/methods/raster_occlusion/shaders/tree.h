// A tree of boxes: interior nodes first, then one leaf an object (BoxTree).
struct NodeData {
  uint first_child, child_count;  // of `children`
};
layout(buffer_reference, scalar) readonly buffer NodeBuffer {
  NodeData at[];
};
layout(buffer_reference, scalar) buffer TestBuffer {
  uint vertex_count, instance_count, first_vertex, first_instance;  // VkDrawIndirectCommand
};

const uint kNoParent = 0xffffffff;
const uint kBoxVertices = 36;
