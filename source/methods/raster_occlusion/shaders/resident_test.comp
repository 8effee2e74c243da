#version 460
#include "vulkan/shared.h"

#include "vulkan/shaders/view.h"

#include "boxes.h"
#include "state.h"
layout(local_size_x = 32) in;
#include "vulkan/shaders/invocation.h"

// One group a part of a chunk that is in, one invocation an object: frustum and contribution; boxes at the near plane
// are seen untested; then what spares a box the raster test: it is dropped if it lies behind the farthest
// depth of every tile it touches (Greene et al. 1993), unless it touches many, and seen if a point of it is.
layout(buffer_reference, scalar) readonly buffer FloatBuffer { float at[]; };
struct Draw {
  uint vertex_count, instance_count, first_vertex, first_instance;  // VkDrawIndirectCommand
};
// Of boxes wholly in the picture, listed from the front, and of those across its edge, from the back.
layout(buffer_reference, scalar) buffer DrawBuffer { Draw at[2]; };

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer state;
  WordBuffer chunks_in;      // three times the chunk's number and the part's, bit 31: wholly in the frustum
  WordBuffer chunk_objects;  // 97 words a chunk: how many, ids
  FloatBuffer depth;  // rows padded to whole tiles
  FloatBuffer tiles;
  WordBuffer list;
  DrawBuffer test;
  uint frame, parts_in;
};

const uint kParts = 3, kWords = 97;
const uint kFaceVertices = 18;
const uint kDepthTile = 4;  // pixels, the side of a tile of depth
const uint kMostTiles = 1024;
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
  const uint row = (uint(size.x) + kDepthTile - 1) / kDepthTile * kDepthTile;
  return !hides(depth.at[pixel.y * row + pixel.x], clip.z / clip.w);
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

// Whether a tile that the rectangle touches leaves the depth open, or so many are touched that looking costs
// more than the raster test.
bool tiles_leave_open(Footprint print) {
  const uvec2 image = uvec2(view.width, view.height), edge = (image - 1) / kDepthTile;
  if (any(lessThan(print.high, vec2(0))) || any(greaterThan(print.low, vec2(image)))) return false;
  const uvec2 first = min(uvec2(max(print.low, vec2(0))) / kDepthTile, edge);
  const uvec2 last = min(uvec2(min(print.high, vec2(image))) / kDepthTile, edge);
  const uint across = last.x - first.x + 1, count = across * (last.y - first.y + 1);
  bool open = count > kMostTiles;
  for (uint i = 0; i < count && !open; ++i) {
    open = !hides(tiles.at[(first.y + i / across) * (edge.x + 1) + first.x + i % across], print.nearest);
  }
  return open;
}

void main() {
  if (workgroup() >= parts_in) return;
  const uint entry = chunks_in.at[workgroup()], part = entry & 0x7fffffff;
  const uint chunk = kWords * (part / kParts), i = 32 * (part % kParts) + gl_LocalInvocationID.x;
  if (i >= chunk_objects.at[chunk]) return;
  const uint object = chunk_objects.at[chunk + 1 + i];
  const BoxData box = boxes.at[object];
  const vec3 centre = box.centre_radius.xyz;
  const vec3 half_extent = widened(centre, box.half_extent.xyz);
  if ((entry & 0x80000000) == 0 && outside(centre, half_extent)) return;
  if (!contributes(box.centre_radius, half_extent)) return;
  const uint before = state_bits(frame - 1, state.at[object]);
  const bool drawn = (before & kSeen) != 0;
  const uint bits = drawn ? kInView | kDrawnEarly : kInView;
  // What is drawn early for the second time was seen with all else there: whether it still shows is asked in one
  // frame of four (Mattausch, Bittner & Wimmer 2008).
  const bool rests = drawn && (before & kDrawnEarly) != 0 && (object + frame) % 4 != 0;
  bool seen = rests || reaches_near_plane(centre, half_extent), unsure = false, inside = false;
  if (!seen) {
    const Footprint print = footprint(centre, half_extent);
    unsure = print.whole || tiles_leave_open(print);
    inside = !print.whole && all(greaterThan(print.low, vec2(0))) &&
             all(lessThan(print.high, vec2(view.width, view.height)));
    // A small box is cheap to rasterise, and may miss the pixel's middle next to the point.
    const bool large = !print.whole && all(greaterThan(print.high - print.low, vec2(kLarge)));
    if (unsure && large) seen = shows_somewhere(centre, half_extent);
  }
  state.at[object] = state_word(frame, seen ? bits | kSeen : bits);
  if (!unsure || seen) return;
  if (inside) {
    list.at[atomicAdd(test.at[0].vertex_count, kFaceVertices) / kFaceVertices] = object;
  } else {
    atomicAdd(test.at[1].vertex_count, kFaceVertices);
    list.at[(atomicAdd(test.at[1].first_vertex, -kFaceVertices) - kFaceVertices) / kFaceVertices] = object;
  }
}
