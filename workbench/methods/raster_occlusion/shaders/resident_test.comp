#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "resident.h"
#include "state.h"
layout(local_size_x = kGroup) in;
#include "workbench/device/shaders/invocation.h"

// One group a part of a chunk that is in, one lane an object: frustum and contribution; boxes at the near plane
// are seen untested; the rest ask for tiles, unless they touch so many that looking costs more than the raster test.
const uint kMostTiles = 1024;
// Pixels. A smaller box is cheap to rasterise, and may miss the pixel's middle next to its point.
const float kLarge = 8;

// What to ask about the object, kNobody where it lies beside the picture.
Question asked_of(uint object, Footprint print) {
  const vec2 image = vec2(image_size());
  if (any(lessThan(print.high, vec2(0))) || any(greaterThan(print.low, image))) object = kNobody;
  const uvec2 edge = tiles_in_image() - 1;
  const uvec2 first = min(uvec2(max(print.low, vec2(0))) / kDepthTile, edge);
  const uvec2 last = min(uvec2(min(print.high, image)) / kDepthTile, edge), span = last - first + 1;
  uint traits = 0;
  if (all(greaterThan(print.low, vec2(0))) && all(lessThan(print.high, image))) traits |= kInside;
  if (all(greaterThan(print.high - print.low, vec2(kLarge)))) traits |= kHasPoints;
  if (span.x * span.y <= kMostTiles) traits |= kHasTiles;
  if (print.whole) traits = 0;
  return Question(object, packed(first), packed(last), traits, print.nearest);
}

// Has the blocks made whose tiles are asked for.
void ask_for_blocks(Question asked) {
  if (asked.object == kNobody || (asked.traits & kHasTiles) == 0) return;
  const uvec2 size = blocks_in_image(), first = unpacked(asked.first), last = unpacked(asked.last);
  for (uint y = first.y / kBlock; y <= last.y / kBlock; ++y) {
    for (uint x = first.x / kBlock; x <= last.x / kBlock; ++x) {
      // Looking first spares most of the atomic exchanges, which llvmpipe does one lane after another.
      if (blocks.at[y * size.x + x] != 0 || atomicExchange(blocks.at[y * size.x + x], 1) != 0) continue;
      const uint block = atomicAdd(test.blocks, 1);
      blocks.at[size.x * size.y + block] = packed(uvec2(x, y));
      if (block < widest) {
        atomicAdd(test.block_groups.x, 1);
      } else if (block % widest == 0) {
        atomicAdd(test.block_groups.y, 1);
      }
    }
  }
}

// What is asked about object i of a part's chunk, kNobody where nothing need be.
Question question_of(uint entry, uint chunk, uint i) {
  const Question none = Question(kNobody, 0, 0, 0, 0);
  if (i >= chunk_objects.at[chunk]) return none;
  const uint object = chunk_objects.at[chunk + 1 + i];
  const BoxData box = boxes.at[object];
  const vec3 centre = box.centre_radius.xyz;
  const vec3 half_extent = widened(centre, box.half_extent.xyz);
  if ((entry & 0x80000000) == 0 && outside(centre, half_extent)) return none;
  if (!contributes(box.centre_radius, half_extent)) return none;
  const uint before = state_bits(frame - 1, state.at[object]);
  const bool drawn = (before & kSeen) != 0;
  const uint bits = drawn ? kInView | kDrawnEarly : kInView;
  // What is drawn early for the second time was seen with all else there: whether it still shows is asked in one
  // frame of four (Mattausch, Bittner & Wimmer 2008).
  const bool rests = drawn && (before & kDrawnEarly) != 0 && (SIGHTLINE_MUTANT(drawn_early_for_ever) ? true : (object + frame) % 4 != 0);
  const bool seen =
      SIGHTLINE_MUTANT(resident_chunk_by_frustum) ? true : rests || reaches_near_plane(centre, half_extent);
  state.at[object] = state_word(frame, seen ? bits | kSeen : bits);
  return seen ? none : asked_of(object, footprint(centre, half_extent));
}

void main() {
  if (workgroup() >= parts_in) return;
  const uint entry = chunks_in.at[workgroup()], part = entry & 0x7fffffff;
  const uint chunk = kWords * (part / kParts), i = kGroup * (part % kParts) + gl_LocalInvocationID.x;
  const Question asked = question_of(entry, chunk, i);
  questions.at[invocation()] = asked;
  ask_for_blocks(asked);
}
