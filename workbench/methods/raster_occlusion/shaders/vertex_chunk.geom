#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"

// Figure 2 of Lee & Shin 2023, geometry stage: the box restored out of its vertex. Faces that
// look away are behind those that do not, and are left out.
layout(points) in;
layout(triangle_strip, max_vertices = 12) out;

layout(location = 0) in vec3 box_centre[];
layout(location = 1) in vec3 box_half_extent[];
layout(location = 2) in flat uint box_object[];
layout(location = 3) in flat uint outcome[];
layout(location = 0) out flat uint id;

void emit(vec4 position) {
  id = box_object[0];
  gl_Position = SIGHTLINE_MUTANT(vertex_chunk_by_frustum) ? before_all(position) : position;
  EmitVertex();
}

void emit_face(vec4 middle, vec4 a, vec4 b, float slack) {
  emit(nearer(middle - a - b, slack));
  emit(nearer(middle + a - b, slack));
  emit(nearer(middle - a + b, slack));
  emit(nearer(middle + a + b, slack));
  EndPrimitive();
}

void main() {
  if (outcome[0] == 0) return;
  if (outcome[0] == 2) {
    for (uint i = 0; i < 4; ++i) emit(certain_mark(i));
    EndPrimitive();
    return;
  }
  const vec3 centre = box_centre[0], half_extent = box_half_extent[0];
  const float slack = depth_slack(centre, half_extent);
  const vec4 middle = view.world_to_clip * vec4(centre, 1);
  const vec4 x = view.world_to_clip[0] * half_extent.x, y = view.world_to_clip[1] * half_extent.y,
             z = view.world_to_clip[2] * half_extent.z;
  const vec3 sides = vec3(facing(0, centre, half_extent), facing(1, centre, half_extent),
                          facing(2, centre, half_extent));
  if (sides.x != 0) emit_face(middle + sides.x * x, y, z, slack);
  if (sides.y != 0) emit_face(middle + sides.y * y, z, x, slack);
  if (SIGHTLINE_MUTANT(vertex_chunk_without_a_face) ? false : sides.z != 0) emit_face(middle + sides.z * z, x, y, slack);
}
