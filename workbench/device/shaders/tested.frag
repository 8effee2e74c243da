#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "shading.h"
#include "tested.h"

// Cut-outs, and whatever is drawn from one side that no rasteriser's culling takes care of.
layout(push_constant, scalar) uniform Push {
  ObjectBuffer objects;
  WordBuffer list;
  LookBuffer looks;
};

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in flat uint object;
layout(location = 3) in flat uint colour;
layout(location = 4) in vec2 coordinate;
layout(location = 0) out vec4 shade;

void main() {
  const ObjectData data = objects.at[object];
  if (!shows_side(data.look) || !shows_texel(data, coordinate, looks)) discard;
  shade = shade_of(world_position, world_normal, colour);
}
