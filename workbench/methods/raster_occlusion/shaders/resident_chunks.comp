#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "resident.h"
#include "workbench/device/shaders/frame_depth.h"
#include "resident_tiles.h"
layout(local_size_x = kGroup) in;
#include "workbench/device/shaders/invocation.h"

// One lane a chunk that is in: where the depth so far hides its bounds nothing is asked of its objects.
void main() {
  if (invocation() >= chunks) return;
  const ChunkIn chunk = chunks_in.at[invocation()];
  const vec3 centre = chunk.bounds.centre_radius.xyz;
  const vec3 half_extent = widened(centre, chunk.bounds.half_extent.xyz);
  if (!reaches_near_plane(centre, half_extent) && !leaves_open(footprint(centre, half_extent))) return;
  const uint first = atomicAdd(test.parts, chunk.parts), end = first + chunk.parts;
  for (uint part = 0; part < chunk.parts; ++part) {
    parts.at[first + part] = (chunk.chunk & kWhollyIn) | (kParts * (chunk.chunk & ~kWhollyIn) + part);
  }
  const uvec3 groups = in_rows(end, widest);
  atomicMax(test.part_groups.x, groups.x);
  atomicMax(test.part_groups.y, groups.y);
}
