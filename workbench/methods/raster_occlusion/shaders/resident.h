// What the steps of resident-chunk's test share: depth tiles are made of the picture so far, chunks in view
// are held against them, and of the chunks that they leave the objects.
#include "library/geometry/mutant.h"

const uint kParts = 3, kWords = 97;  // parts of a chunk that a workgroup takes; words of a chunk
const uint kFaceVertices = 18;
const uint kGroup = 32;     // lanes, an object or a chunk each
const uint kDepthTile = 4;  // pixels, the side of a tile of depth
const uint kBlock = 8;      // tiles, the side of what a workgroup makes
const uint kWhollyIn = 0x80000000;

struct ChunkIn {
  BoxData bounds;
  uint chunk;  // kWhollyIn: wholly in the frustum
  uint parts;
};
layout(buffer_reference, scalar) readonly buffer ChunkInBuffer {
  ChunkIn at[];
};

struct Draw {
  uint vertex_count, instance_count, first_vertex, first_instance;  // VkDrawIndirectCommand
};
layout(buffer_reference, scalar) buffer TestBuffer {
  Draw draws[2];  // boxes wholly in the picture, listed from the front; those across its edge, from the back
  uvec3 part_groups;  // VkDispatchIndirectCommand, laid out as invocation.h reads them
  uint parts;         // of chunks that the tiles leave
};
layout(buffer_reference, scalar) buffer FloatBuffer {
  float at[];
};

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer state;
  ChunkInBuffer chunks_in;
  WordBuffer chunk_objects;  // 97 words a chunk: how many, ids
  WordBuffer parts;  // that the tiles leave: three times the chunk's number and the part's, or kWhollyIn
  FloatBuffer tiles;
  WordBuffer slots,
      candidates;   // the object's place in the order of drawing; a bit a slot, who may be listed
  WordBuffer list;  // boxes for the raster test
  TestBuffer test;
  uint frame, chunks, widest;  // chunks in; widest: workgroups that fit side by side
  uvec4 blocks;                // those of which tiles are made: the first, and how many across and down
  uint ordered;                // slots that have candidates
};

// In pixels, in tiles.
uvec2 image_size() {
  return uvec2(view.width, view.height);
}
uvec2 tiles_in_image() {
  return (image_size() + kDepthTile - 1) / kDepthTile;
}
// Of four depths.
float farthest(vec4 depths) {
  const float low = min(min(depths.x, depths.y), min(depths.z, depths.w));
  const float high = max(max(depths.x, depths.y), max(depths.z, depths.w));
  return (SIGHTLINE_MUTANT(tiles_of_the_nearest) ? view.reversed == 0 : view.reversed != 0) ? low : high;
}
