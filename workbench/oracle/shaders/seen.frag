#version 460
#include "workbench/device/shared.h"
// Only what passes the depth test may say that it is seen.
layout(early_fragment_tests) in;

layout(push_constant, scalar) uniform Push {
  ObjectBuffer objects;
  WordBuffer list;
  WordBuffer seen;
};

layout(location = 2) in flat uint object;

void main() {
  seen.at[object] = 1;
}
