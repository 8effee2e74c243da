#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "state.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// Drawn objects in a tile where something was drawn late: where depths are equal, the order of drawing decides.
layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  ObjectBuffer data;
  WordBuffer state, tiles;
  uint objects, frame;
};

void main() {
  const uint object = invocation();
  if (object >= objects) return;
  const uint bits = state_bits(frame, state.at[object]);
  if ((bits & (kDrawnEarly | kSeen)) == 0 || (data.at[object].look & kSeeThrough) != 0) return;
  uvec2 first, last;
  tile_range(footprint(boxes.at[object].centre_radius.xyz, boxes.at[object].half_extent.xyz), first, last);
  const uint columns = tile_count().x;
  for (uint y = first.y; y <= last.y; ++y) {
    for (uint x = first.x; x <= last.x; ++x) {
      if (tiles.at[1 + y * columns + x] == frame) {
        state.at[object] = state_word(frame, bits | kEqualDepth);
        return;
      }
    }
  }
}
