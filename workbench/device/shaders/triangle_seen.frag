#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/tested.h"
// Only what passes the depth test may say that it is seen.
layout(early_fragment_tests) in;

layout(push_constant, scalar) uniform Push {
  LookBuffer looks;
  CoordinateBuffer coordinates;
  WordBuffer seen;
};

layout(location = 1) in flat uint object;

void main() {
  if (shows_side(looks.objects.at[object].look & ~kMirrored)) seen.at[object] = 1;
}
