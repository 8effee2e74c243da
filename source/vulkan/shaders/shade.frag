#version 460
#include "vulkan/shared.h"

#include "shading.h"

layout(push_constant, scalar) uniform Push {
  ViewBuffer view;
};

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 3) in flat uint colour;
layout(location = 0) out vec4 shade;

void main() {
  shade = shade_of(view.view, world_position, world_normal, colour);
}
