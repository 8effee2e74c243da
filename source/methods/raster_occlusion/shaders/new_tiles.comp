#version 460
#include "vulkan/shared.h"

#include "vulkan/shaders/view.h"

#include "boxes.h"
#include "state.h"
layout(local_size_x = 256) in;

// Takes over the marks, and notes the tiles that objects drawn late may touch.
layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  ObjectBuffer data;
  WordBuffer marks, state, tiles;
  uint objects, frame;
};

void main() {
  const uint object = gl_GlobalInvocationID.x;
  if (object == 0) tiles.at[0] = frame;
  if (object >= objects || marks.at[object] != frame) return;
  const uint bits = state_bits(frame, state.at[object]) | kSeen;
  state.at[object] = state_word(frame, bits);
  if (bits != (kInView | kSeen) || data.at[object].transparent != 0) return;
  uvec2 first, last;
  tile_range(footprint(boxes.at[object].centre_radius.xyz, boxes.at[object].half_extent.xyz), first, last);
  const uint columns = tile_count().x;
  for (uint y = first.y; y <= last.y; ++y) {
    for (uint x = first.x; x <= last.x; ++x) tiles.at[1 + y * columns + x] = frame;
  }
}
