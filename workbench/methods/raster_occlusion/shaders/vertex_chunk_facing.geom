#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"

// Of the box only the faces that look at the eye: the others are behind them.
layout(triangle_strip, max_vertices = 12) out;
#include "vertex_chunk_box.h"

void main() {
  if (settled()) return;
  const vec3 centre = box_centre[0], half_extent = box_half_extent[0];
  const float slack = depth_slack(centre, half_extent);
  const ClipBox box = clip_box();
  const float x = facing(0, centre, half_extent), y = facing(1, centre, half_extent),
              z = facing(2, centre, half_extent);
  if (x != 0) emit_face(box.middle + x * box.x, box.y, box.z, slack);
  if (y != 0) emit_face(box.middle + y * box.y, box.z, box.x, slack);
  if (z != 0) emit_face(box.middle + z * box.z, box.x, box.y, slack);
}
