#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/tested.h"

layout(push_constant, scalar) uniform Push {
  LookBuffer looks;
  CoordinateBuffer coordinates;
  WordBuffer seen;
};

layout(location = 1) in flat uint object;
layout(location = 0) out uint id;

void main() {
  if (!shows_side(looks.objects.at[object].look & ~kMirrored)) discard;
  id = object;
}
