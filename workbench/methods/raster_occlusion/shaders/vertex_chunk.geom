#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"

// Figure 2 of Lee & Shin 2023, geometry stage: the box restored out of its vertex.
layout(triangle_strip, max_vertices = 24) out;
#include "vertex_chunk_box.h"

void main() {
  if (settled()) return;
  const float slack = depth_slack(box_centre[0], box_half_extent[0]);
  const ClipBox box = clip_box();
  // Each as seen from without, so that those that look away can be told.
  emit_face(box.middle + box.x, box.y, box.z, slack);
  emit_face(box.middle - box.x, box.z, box.y, slack);
  emit_face(box.middle + box.y, box.z, box.x, slack);
  emit_face(box.middle - box.y, box.x, box.z, slack);
  if (SIGHTLINE_MUTANT(vertex_chunk_without_a_face)) return;
  emit_face(box.middle + box.z, box.x, box.y, slack);
  emit_face(box.middle - box.z, box.y, box.x, slack);
}
