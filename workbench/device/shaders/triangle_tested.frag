#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "workbench/device/shaders/shading.h"
#include "workbench/device/shaders/tested.h"

layout(push_constant, scalar) uniform Push {
  LookBuffer looks;
  CoordinateBuffer coordinates;
  WordBuffer seen;
};

layout(location = 0) in vec3 world_position;
layout(location = 1) in flat uint object;
layout(location = 2) in flat uint colour;
layout(location = 3) in vec2 coordinate;
layout(location = 0) out vec4 shade;

void main() {
  const vec3 flat_normal = cross(dFdx(world_position), dFdy(world_position));  // of the triangle itself
  const ObjectData data = looks.objects.at[object];
  if (!shows_side(data.look & ~kMirrored) || !shows_texel(data, coordinate, looks)) discard;
  shade = shade_of(world_position, flat_normal, colour);
}
