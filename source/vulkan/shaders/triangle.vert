#version 460
#include "vulkan/shared.h"

#include "vulkan/shaders/view.h"

// Draws ranges of world-space triangles. The first instance of a range is its first triangle, so that with the
// primitive's number in the draw every fragment knows its triangle.
layout(push_constant, scalar) uniform Push {
  ObjectBuffer objects;
  PositionBuffer positions;
  WordBuffer owners;
};

layout(location = 0) out vec3 world_position;
layout(location = 1) out flat uint first_triangle;
invariant gl_Position;

void main() {
  world_position = positions.at[gl_VertexIndex];
  first_triangle = gl_InstanceIndex;
  gl_Position = on_pixel_grid(world_position);
}
