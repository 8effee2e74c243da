#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "state.h"
layout(local_size_x = 64) in;
#include "workbench/device/shaders/invocation.h"

// Notes the tiles that objects drawn late may touch, and has the work done that follows from there being any.
// VkDispatchIndirectCommands: of this shader, by what was listed late; of what follows, zeros as yet.
layout(buffer_reference, scalar) readonly buffer ListedBuffer { uvec3 groups; uint count; };
layout(buffer_reference, scalar) buffer FollowUpBuffer { uvec3 equal_depth, scan; };

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer late;
  FollowUpBuffer follow_up;
  ListedBuffer listed;
  WordBuffer tiles;
  uint objects, scan_groups, frame, widest;
};

void main() {
  const uint i = invocation();
  if (i >= listed.count) return;
  if (i == 0) {
    tiles.at[0] = frame;
    follow_up.equal_depth = in_rows((objects + 255) / 256, widest);
    follow_up.scan = uvec3(scan_groups, 1, 1);
  }
  const BoxData box = boxes.at[late.at[i]];
  uvec2 first, last;
  tile_range(footprint(box.centre_radius.xyz, box.half_extent.xyz), first, last);
  const uint columns = tile_count().x;
  for (uint y = first.y; y <= last.y; ++y) {
    for (uint x = first.x; x <= last.x; ++x)
      tiles.at[1 + y * columns + x] = SIGHTLINE_MUTANT(ties_not_drawn_again) ? 0 : frame;
  }
}
