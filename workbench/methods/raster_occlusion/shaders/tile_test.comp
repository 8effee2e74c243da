#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "resident.h"
#include "state.h"
#include "workbench/device/shaders/frame_depth.h"
layout(local_size_x = kGroup) in;
#include "workbench/device/shaders/invocation.h"

// What spares a box the raster test, one lane a question: it is dropped if it lies behind the farthest depth of
// every tile it touches (Greene et al. 1993), and seen if a point of it is.
bool hides(float depth, float nearest) {
  return view.reversed != 0 ? nearest < depth : nearest > depth;
}

// Whether a point of the box can be seen. If it can, so can the box's face before it, and the raster test would
// say the same.
bool shows(vec3 at, float slack) {
  const vec4 clip = clip_position(at, slack);
  if (any(greaterThanEqual(abs(clip.xy), vec2(clip.w)))) return false;
  const vec2 size = vec2(image_size());
  const ivec2 pixel = ivec2(min((vec2(clip.x, -clip.y) / clip.w + 1) * 0.5 * size, size - 1));
  return !hides(texelFetch(frame_depth, pixel, 0).x, clip.z / clip.w);
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

bool tiles_leave_open(Question asked) {
  if ((asked.traits & kHasTiles) == 0) return true;
  const uvec2 first = unpacked(asked.first), last = unpacked(asked.last);
  const uint columns = tiles_in_image().x;
  bool open = false;
  for (uvec2 tile = first; tile.y <= last.y && !open;) {
    open = !hides(tiles.at[tile.y * columns + tile.x], asked.nearest);
    const bool ends = tile.x == last.x;
    tile = uvec2(ends ? first.x : tile.x + 1, ends ? tile.y + 1 : tile.y);
  }
  return open;
}

void main() {
  if (workgroup() >= parts_in) return;
  const Question asked = questions.at[invocation()];
  if (asked.object == kNobody || !tiles_leave_open(asked)) return;
  const BoxData box = boxes.at[asked.object];
  const vec3 centre = box.centre_radius.xyz;
  if ((asked.traits & kHasPoints) != 0 && shows_somewhere(centre, widened(centre, box.half_extent.xyz))) {
    state.at[asked.object] |= kSeen;
  } else if ((asked.traits & kInside) != 0) {
    list.at[atomicAdd(test.draws[0].vertex_count, kFaceVertices) / kFaceVertices] = asked.object;
  } else {
    atomicAdd(test.draws[1].vertex_count, kFaceVertices);
    const uint place = atomicAdd(test.draws[1].first_vertex, -kFaceVertices) - kFaceVertices;
    list.at[place / kFaceVertices] = asked.object;
  }
}
