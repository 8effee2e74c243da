#version 460
#include "vulkan/shared.h"

#include "vulkan/shaders/view.h"

#include "boxes.h"
#include "resident.h"
layout(local_size_x = 96) in;

// Drops the boxes that lie behind the farthest depth of every tile they touch (Greene et al. 1993); the rest goes
// to the raster test, and so do boxes over many tiles.
layout(buffer_reference, scalar) readonly buffer FloatBuffer { float at[]; };

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer candidates, list;
  FloatBuffer tiles;
  TestBuffer test;
};

const uint kMostTiles = 64;

void main() {
  if (gl_GlobalInvocationID.x >= test.candidates) return;
  const uint object = candidates.at[gl_GlobalInvocationID.x];
  const BoxData box = boxes.at[object];
  const Footprint print = footprint(box.centre_radius.xyz, widened(box.centre_radius.xyz, box.half_extent.xyz));
  const uvec2 image = uvec2(view.width, view.height), edge = (image - 1) / kDepthTile;
  bool seen = print.whole;
  if (!seen) {
    if (any(lessThan(print.high, vec2(0))) || any(greaterThan(print.low, vec2(image)))) return;
    const uvec2 first = min(uvec2(max(print.low, vec2(0))) / kDepthTile, edge);
    const uvec2 last = min(uvec2(min(print.high, vec2(image))) / kDepthTile, edge);
    const uint across = last.x - first.x + 1, count = across * (last.y - first.y + 1);
    seen = count > kMostTiles;
    for (uint i = 0; i < count && !seen; ++i) {
      const float farthest = tiles.at[(first.y + i / across) * (edge.x + 1) + first.x + i % across];
      seen = view.reversed != 0 ? print.nearest >= farthest : print.nearest <= farthest;
    }
  }
  if (seen) list.at[atomicAdd(test.vertex_count, kFaceVertices) / kFaceVertices] = object;
}
