#version 460
#include "vulkan/shared.h"

#include "boxes.h"

// Figure 2 of Lee & Shin 2023, geometry stage: the box restored out of its vertex, as one strip.
layout(points) in;
layout(triangle_strip, max_vertices = 14) out;

layout(push_constant, scalar) uniform Push {
  ViewBuffer view_data;
};

layout(location = 0) in vec3 box_centre[];
layout(location = 1) in vec3 box_half_extent[];
layout(location = 2) in flat uint box_object[];
layout(location = 3) in flat uint fate[];
layout(location = 0) out flat uint id;

// All twelve triangles of a box in 14 vertices.
const uint kStrip[14] = uint[](6, 7, 2, 3, 1, 7, 5, 6, 4, 2, 0, 1, 4, 5);

void main() {
  if (fate[0] == 0) return;
  const ViewData view = view_data.view;
  const bool certain = fate[0] == 2;
  vec4 corners[8];
  for (uint i = 0; i < 8; ++i) {
    corners[i] = certain ? certain_mark(view, i) : clip_position(view, corner(box_centre[0], box_half_extent[0], i));
  }
  const uint count = certain ? 4 : 14;
  for (uint i = 0; i < count; ++i) {
    id = box_object[0];
    gl_Position = corners[certain ? i : kStrip[i]];
    EmitVertex();
  }
  EndPrimitive();
}
