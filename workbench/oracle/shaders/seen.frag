#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/tested.h"
// Only what passes the depth test may say that it is seen: whatever its alpha, for nobody need know it who
// decides what to draw.
layout(early_fragment_tests) in;

layout(push_constant, scalar) uniform Push {
  ObjectBuffer objects;
  WordBuffer list;
  WordBuffer seen;
};

layout(location = 2) in flat uint object;

void main() {
  if (shows_side(objects.at[object].look)) seen.at[object] = 1;
}
