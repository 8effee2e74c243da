#version 460
#include "vulkan/shared.h"

// The depth test comes first: only a box with a visible pixel marks.
layout(early_fragment_tests) in;

layout(push_constant, scalar) uniform Push {
  ViewBuffer view_data;
  BoxBuffer boxes;
  WordBuffer marks;
};

layout(location = 0) in flat uint id;

void main() {
  marks.at[id] = 1;
}
