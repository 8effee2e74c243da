#version 460
#include "vulkan/shared.h"

#include "vulkan/shaders/view.h"

#include "boxes.h"

// Figure 2 of Lee & Shin 2023, geometry stage: the box restored out of its vertex, as one strip.
layout(points) in;
layout(triangle_strip, max_vertices = 14) out;

layout(location = 0) in vec3 box_centre[];
layout(location = 1) in vec3 box_half_extent[];
layout(location = 2) in flat uint box_object[];
layout(location = 3) in flat uint fate[];
layout(location = 0) out flat uint id;

void emit(vec4 position) {
  id = box_object[0];
  gl_Position = position;
  EmitVertex();
}

void main() {
  if (fate[0] == 0) return;
  if (fate[0] == 2) {
    for (uint i = 0; i < 4; ++i) emit(certain_mark(i));
    EndPrimitive();
    return;
  }
  // All twelve triangles of a box in 14 vertices; written out, as an array indexed in a loop is slow.
  vec4 c[8];
  for (uint i = 0; i < 8; ++i) c[i] = clip_position(corner(box_centre[0], box_half_extent[0], i));
  emit(c[6]);
  emit(c[7]);
  emit(c[2]);
  emit(c[3]);
  emit(c[1]);
  emit(c[7]);
  emit(c[5]);
  emit(c[6]);
  emit(c[4]);
  emit(c[2]);
  emit(c[0]);
  emit(c[1]);
  emit(c[4]);
  emit(c[5]);
  EndPrimitive();
}
