#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "resident.h"
#include "state.h"
#include "workbench/device/shaders/frame_depth.h"
#include "resident_tiles.h"
layout(local_size_x = kGroup) in;
#include "workbench/device/shaders/invocation.h"

// One group a part of a chunk that the tiles leave, one lane an object: frustum and contribution; boxes at the
// near plane are seen untested; the rest are held against the tiles, and what these leave is seen if a point
// of it is, or else rasterised.

// Pixels. A smaller box is cheap to rasterise, and may miss the pixel's middle next to its point.
const float kLarge = 8;

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

void name_candidate(uint object) {
  const uint slot = slots.at[object];
  if (slot < ordered) atomicOr(candidates.at[slot / 32], 1u << slot % 32);
}

// Boxes wholly in the picture are listed from the front, those across its edge from the back.
void rasterise(uint object, bool inside) {
  if (inside) {
    list.at[atomicAdd(test.draws[0].vertex_count, kFaceVertices) / kFaceVertices] = object;
  } else {
    atomicAdd(test.draws[1].vertex_count, kFaceVertices);
    const uint place = atomicAdd(test.draws[1].first_vertex, -kFaceVertices) - kFaceVertices;
    list.at[place / kFaceVertices] = object;
  }
}

void main() {
  if (workgroup() >= test.parts) return;
  const uint entry = parts.at[workgroup()], part = entry & ~kWhollyIn;
  const uint chunk = kWords * (part / kParts), i = kGroup * (part % kParts) + gl_LocalInvocationID.x;
  if (i >= chunk_objects.at[chunk]) return;
  const uint object = chunk_objects.at[chunk + 1 + i];
  const BoxData box = boxes.at[object];
  const vec3 centre = box.centre_radius.xyz;
  const vec3 half_extent = widened(centre, box.half_extent.xyz);
  if ((entry & kWhollyIn) == 0 && outside(centre, half_extent)) return;
  if (!contributes(box.centre_radius, half_extent)) return;
  const uint before = state_bits(frame - 1, state.at[object]);
  const bool drawn = (before & kSeen) != 0;
  const uint bits = drawn ? kInView | kDrawnEarly : kInView;
  // What is drawn early for the second time was seen with all else there: whether it still shows is asked in one
  // frame of four (Mattausch, Bittner & Wimmer 2008).
  const bool rests = drawn && (before & kDrawnEarly) != 0 && (SIGHTLINE_MUTANT(drawn_early_for_ever) ? true : (object + frame) % 4 != 0);
  bool asked = false;
  bool seen = SIGHTLINE_MUTANT(resident_chunk_by_frustum) ? true : rests || reaches_near_plane(centre, half_extent);
  if (!seen) {
    const Footprint print = footprint(centre, half_extent);
    if (leaves_open(print)) {
      const bool large = !print.whole && all(greaterThan(print.high - print.low, vec2(kLarge)));
      const bool inside = !print.whole && all(greaterThan(print.low, vec2(0))) && all(lessThan(print.high, vec2(image_size())));
      seen = large && shows_somewhere(centre, half_extent);
      asked = !seen;
      if (asked) rasterise(object, inside);
    }
  }
  if (seen || (SIGHTLINE_MUTANT(asked_boxes_no_candidates) ? false : asked)) name_candidate(object);
  state.at[object] = state_word(frame, seen ? bits | kSeen : bits);
}
