#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "resident.h"
#include "workbench/device/shaders/frame_depth.h"
layout(local_size_x = kBlock * kBlock) in;
#include "workbench/device/shaders/invocation.h"

// The farthest depth of each tile of 4 x 4 pixels: a group a block, a lane a tile. Past the picture's edge the
// sampler repeats it.
void main() {
  const uvec2 size = tiles_in_image();
  const uint lane = gl_LocalInvocationID.x;
  const uvec2 block = blocks.xy + uvec2(workgroup() % blocks.z, workgroup() / blocks.z);
  const uvec2 tile = kBlock * block + uvec2(lane % kBlock, lane / kBlock);
  if (any(greaterThanEqual(tile, size))) return;
  // Four texels about each point, which lies where they meet.
  const vec2 first = vec2(kDepthTile * tile), scale = 1 / vec2(image_size());
  const vec4 a = textureGather(frame_depth, (first + vec2(1, 1)) * scale);
  const vec4 b = textureGather(frame_depth, (first + vec2(3, 1)) * scale);
  const vec4 c = textureGather(frame_depth, (first + vec2(1, 3)) * scale);
  const vec4 d = textureGather(frame_depth, (first + vec2(3, 3)) * scale);
  tiles.at[tile.y * size.x + tile.x] = farthest(vec4(farthest(a), farthest(b), farthest(c), farthest(d)));
}
