#version 460
#include "vulkan/shared.h"

#include "vulkan/shaders/view.h"
#include "vulkan/shaders/shading.h"

layout(push_constant, scalar) uniform Push {
  ObjectBuffer objects;
  PositionBuffer positions;
  WordBuffer owners;
};

layout(location = 0) in vec3 world_position;
layout(location = 1) in flat uint first_triangle;
layout(location = 0) out vec4 shade;

void main() {
  const vec3 flat_normal = cross(dFdx(world_position), dFdy(world_position));  // of the triangle itself
  const uint owner = owners.at[first_triangle + gl_PrimitiveID];
  shade = shade_of(world_position, flat_normal, objects.at[owner].colour);
}
