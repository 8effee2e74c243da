#version 460
#include "vulkan/shared.h"

#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
layout(local_size_x = 64) in;
#include "vulkan/shaders/invocation.h"

// The farthest depth of each tile of 4 x 4 pixels. Rows are padded to whole tiles. Pixels are read in pairs: llvmpipe
// reads memory lane by lane, at the same cost for a word as for two.
layout(buffer_reference, scalar) readonly buffer PairBuffer { uint64_t at[]; };
layout(buffer_reference, scalar) writeonly buffer FloatBuffer { float at[]; };

layout(push_constant, scalar) uniform Push {
  PairBuffer depth;
  FloatBuffer tiles;
  uint width, height, reversed;
};

const uint kDepthTile = 4;

void main() {
  const uint columns = (width + kDepthTile - 1) / kDepthTile, rows = (height + kDepthTile - 1) / kDepthTile;
  const uint tile = invocation();
  if (tile >= columns * rows) return;
  const uvec2 first = kDepthTile * uvec2(tile % columns, tile / columns);
  float farthest = reversed != 0 ? 1 : 0;
  for (uint y = 0; y < kDepthTile; ++y) {
    const uint row = min(first.y + y, height - 1) * columns * kDepthTile;
    for (uint x = first.x; x < first.x + kDepthTile; x += 2) {
      const vec2 pair = uintBitsToFloat(unpack32(depth.at[(row + x) / 2]));
      const float left = x < width ? pair.x : farthest, right = x + 1 < width ? pair.y : farthest;
      farthest = reversed != 0 ? min(farthest, min(left, right)) : max(farthest, max(left, right));
    }
  }
  tiles.at[tile] = farthest;
}
