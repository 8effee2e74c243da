#version 460
#include "vulkan/shared.h"

#include "vulkan/shaders/view.h"

#include "boxes.h"
#include "resident.h"
layout(local_size_x = 96) in;

// Spares boxes the raster test: marks those of which a point can be seen, and drops those that lie
// behind the farthest depth of every tile they touch (Greene et al. 1993), unless they touch many.
layout(buffer_reference, scalar) readonly buffer FloatBuffer { float at[]; };

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer marks, candidates, list;
  FloatBuffer depth, tiles;
  TestBuffer test;
  uint frame;
};

const uint kMostTiles = 64;
const float kLarge = 8;  // pixels

bool hides(float depth, float nearest) {
  return view.reversed != 0 ? nearest < depth : nearest > depth;
}

// Whether a point of the box can be seen. If it can, so can the box's face before it, and the raster test would
// say the same.
bool shows(vec3 at, float slack) {
  const vec4 clip = clip_position(at, slack);
  if (any(greaterThanEqual(abs(clip.xy), vec2(clip.w)))) return false;
  const vec2 size = vec2(view.width, view.height);
  const uvec2 pixel = min(uvec2((vec2(clip.x, -clip.y) / clip.w + 1) * 0.5 * size), uvec2(size) - 1);
  return !hides(depth.at[pixel.y * uint(size.x) + pixel.x], clip.z / clip.w);
}

// Where the line from the box's middle to the eye leaves it, and just within the corners, which stick out of
// what fills the box.
bool shows_somewhere(vec3 centre, vec3 half_extent) {
  const float slack = depth_slack(centre, half_extent);
  const vec3 away = view.eye.w > 0 ? view.forward.xyz : centre - view.eye.xyz;
  const vec3 share = half_extent / max(abs(away), 1e-30);
  bool shown = shows(centre - away * min(min(share.x, share.y), share.z), slack);
  for (uint i = 0; i < 8 && !shown; ++i) shown = shows(corner(centre, 0.95 * half_extent, i), slack);
  return shown;
}

void main() {
  if (gl_GlobalInvocationID.x >= test.candidates) return;
  const uint object = candidates.at[gl_GlobalInvocationID.x];
  const BoxData box = boxes.at[object];
  const vec3 centre = box.centre_radius.xyz, half_extent = widened(centre, box.half_extent.xyz);
  const Footprint print = footprint(centre, half_extent);
  const uvec2 image = uvec2(view.width, view.height), edge = (image - 1) / kDepthTile;
  bool seen = print.whole;
  if (!seen) {
    if (any(lessThan(print.high, vec2(0))) || any(greaterThan(print.low, vec2(image)))) return;
    const uvec2 first = min(uvec2(max(print.low, vec2(0))) / kDepthTile, edge);
    const uvec2 last = min(uvec2(min(print.high, vec2(image))) / kDepthTile, edge);
    const uint across = last.x - first.x + 1, count = across * (last.y - first.y + 1);
    seen = count > kMostTiles;
    for (uint i = 0; i < count && !seen; ++i) {
      seen = !hides(tiles.at[(first.y + i / across) * (edge.x + 1) + first.x + i % across], print.nearest);
    }
  }
  if (!seen) return;
  // A small box is cheap to rasterise, and may miss the pixel's middle next to the point.
  const bool large = !print.whole && all(greaterThan(print.high - print.low, vec2(kLarge)));
  if (large && shows_somewhere(centre, half_extent)) {
    marks.at[object] = frame;
  } else {
    list.at[atomicAdd(test.vertex_count, kFaceVertices) / kFaceVertices] = object;
  }
}
