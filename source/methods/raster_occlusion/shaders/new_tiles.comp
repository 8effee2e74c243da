#version 460
#include "vulkan/shared.h"

#include "boxes.h"
#include "state.h"
layout(local_size_x = 256) in;

// Takes over the marks, and notes the tiles that objects drawn late may touch.
layout(push_constant, scalar) uniform Push {
  ViewBuffer view_data;
  BoxBuffer boxes;
  ObjectBuffer data;
  WordBuffer marks, state, tiles;
  uint objects;
};

void main() {
  const uint object = gl_GlobalInvocationID.x;
  if (object >= objects || marks.at[object] == 0) return;
  const uint word = state.at[object] | kSeen;
  state.at[object] = word;
  if (word != (kInView | kSeen) || data.at[object].transparent != 0) return;
  const ViewData view = view_data.view;
  uvec2 first, last;
  tile_range(view, footprint(view, boxes.at[object].centre_radius.xyz, boxes.at[object].half_extent.xyz), first, last);
  const uint columns = tile_count(view).x;
  for (uint y = first.y; y <= last.y; ++y) {
    for (uint x = first.x; x <= last.x; ++x) tiles.at[y * columns + x] = 1;
  }
}
