// What the steps of resident-chunk's test share: objects in view ask for the depth tiles that their boxes
// touch, the blocks of tiles that were asked for are made, and the boxes are held against them.
const uint kParts = 3, kWords = 97;  // parts of a chunk that a workgroup takes; words of a chunk
const uint kFaceVertices = 18;
const uint kGroup = 32;     // lanes, an object each
const uint kDepthTile = 4;  // pixels, the side of a tile of depth
const uint kBlock = 8;      // tiles, the side of a block

// What an object asks. Both steps must mean the very same tiles, so they are worked out once.
const uint kNobody = 0xffffffff;
struct Question {
  uint object;       // or kNobody
  uint first, last;  // tiles that its box touches: x | y << 16
  uint traits;       // as below
  float nearest;     // depth
};
const uint kInside = 1;     // lies wholly in the picture
const uint kHasPoints = 2;  // is large enough for its points to tell something
const uint kHasTiles = 4;   // asked for its tiles
layout(buffer_reference, scalar) buffer QuestionBuffer {
  Question at[];
};

struct Draw {
  uint vertex_count, instance_count, first_vertex, first_instance;  // VkDrawIndirectCommand
};
layout(buffer_reference, scalar) buffer TestBuffer {
  Draw draws[2];  // boxes wholly in the picture, listed from the front; those across its edge, from the back
  uvec3 block_groups;  // VkDispatchIndirectCommand, laid out as invocation.h reads them
  uint blocks;         // that were asked for
};
layout(buffer_reference, scalar) buffer FloatBuffer {
  float at[];
};

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer state;
  WordBuffer chunks_in;      // three times the chunk's number and the part's, bit 31: wholly in the frustum
  WordBuffer chunk_objects;  // 97 words a chunk: how many, ids
  QuestionBuffer questions;
  WordBuffer blocks;  // whether each was asked for; then those that were, as x | y << 16
  FloatBuffer tiles;
  WordBuffer list;  // boxes for the raster test
  TestBuffer test;
  uint frame, parts_in, widest;  // widest: workgroups that fit side by side
};

// In pixels, in tiles, in blocks.
uvec2 image_size() {
  return uvec2(view.width, view.height);
}
uvec2 tiles_in_image() {
  return (image_size() + kDepthTile - 1) / kDepthTile;
}
uvec2 blocks_in_image() {
  return (tiles_in_image() + kBlock - 1) / kBlock;
}

uint packed(uvec2 at) {
  return at.x | at.y << 16;
}
uvec2 unpacked(uint word) {
  return uvec2(word & 0xffff, word >> 16);
}
