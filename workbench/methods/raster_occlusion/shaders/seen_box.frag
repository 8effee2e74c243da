#version 460
#include "workbench/device/shared.h"

// The depth test comes first: only a box with a visible pixel is seen.
layout(early_fragment_tests) in;

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer state;
};

layout(location = 0) in flat uint id;
layout(location = 1) in flat uint seen;  // the object's state, once it is

void main() {
  state.at[id] = seen;
}
