// How many objects are tested for occlusion by depth tiles, and the draw that tests what they leave.
layout(buffer_reference, scalar) buffer TestBuffer {
  uint vertex_count, instance_count, first_vertex, first_instance;  // VkDrawIndirectCommand
  uint candidates;
};

const uint kFaceVertices = 18;
const uint kDepthTile = 8;  // pixels, the side of a tile of depth
