#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "workbench/device/shaders/shading.h"

// Colours again what lies nearest, in tiles where something was drawn late.
layout(push_constant, scalar) uniform Push {
  ObjectBuffer objects;
  WordBuffer list;
  WordBuffer tiles;
};

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 3) in flat uint colour;
layout(location = 0) out vec4 shade;

const uint kTile = 64;

void main() {
  const uvec2 at = uvec2(gl_FragCoord.xy) / kTile;
  const uint columns = uint(ceil(view.width / kTile));
  if (tiles.at[1 + at.y * columns + at.x] != tiles.at[0]) discard;
  shade = shade_of(world_position, world_normal, colour);
}
