#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"
#include "workbench/device/shaders/shading.h"

layout(location = 0) in vec3 world_position;
layout(location = 2) in flat uint colour;
layout(location = 0) out vec4 shade;

void main() {
  const vec3 flat_normal = cross(dFdx(world_position), dFdy(world_position));  // of the triangle itself
  shade = shade_of(world_position, flat_normal, colour);
}
