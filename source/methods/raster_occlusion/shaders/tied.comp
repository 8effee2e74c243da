#version 460
#include "vulkan/shared.h"

#include "boxes.h"
#include "state.h"
layout(local_size_x = 256) in;

// Drawn objects in a tile where something was drawn late: where depths are equal, the order of drawing decides.
layout(push_constant, scalar) uniform Push {
  ViewBuffer view_data;
  BoxBuffer boxes;
  ObjectBuffer data;
  WordBuffer marks, state, tiles;
  uint objects;
};

void main() {
  const uint object = gl_GlobalInvocationID.x;
  if (object >= objects) return;
  const uint word = state.at[object];
  if ((word & (kDrawnEarly | kSeen)) == 0 || data.at[object].transparent != 0) return;
  const ViewData view = view_data.view;
  uvec2 first, last;
  tile_range(view, footprint(view, boxes.at[object].centre_radius.xyz, boxes.at[object].half_extent.xyz), first, last);
  const uint columns = tile_count(view).x;
  for (uint y = first.y; y <= last.y; ++y) {
    for (uint x = first.x; x <= last.x; ++x) {
      if (tiles.at[y * columns + x] != 0) {
        state.at[object] = word | kTied;
        return;
      }
    }
  }
}
