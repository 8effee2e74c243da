#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "shading.h"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 3) in flat uint colour;
layout(location = 0) out vec4 shade;

void main() {
  shade = shade_of(world_position, world_normal, colour);
}
