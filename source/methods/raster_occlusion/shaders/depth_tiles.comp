#version 460
#include "vulkan/shared.h"

layout(local_size_x = 64) in;

// The farthest depth of each tile of 4 x 4 pixels.
layout(buffer_reference, scalar) buffer FloatBuffer { float at[]; };

layout(push_constant, scalar) uniform Push {
  FloatBuffer depth, tiles;
  uint width, height, reversed;
};

const uint kDepthTile = 4;

void main() {
  const uint columns = (width + kDepthTile - 1) / kDepthTile, rows = (height + kDepthTile - 1) / kDepthTile;
  const uint tile = gl_GlobalInvocationID.x;
  if (tile >= columns * rows) return;
  const uvec2 first = kDepthTile * uvec2(tile % columns, tile / columns);
  float farthest = reversed != 0 ? 1 : 0;
  for (uint y = 0; y < kDepthTile; ++y) {
    const uint row = min(first.y + y, height - 1) * width;
    for (uint x = 0; x < kDepthTile; ++x) {
      const float here = depth.at[row + min(first.x + x, width - 1)];
      farthest = reversed != 0 ? min(farthest, here) : max(farthest, here);
    }
  }
  tiles.at[tile] = farthest;
}
