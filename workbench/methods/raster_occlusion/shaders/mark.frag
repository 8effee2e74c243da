#version 460
#include "workbench/device/shared.h"

// The depth test comes first: only a box with a visible pixel marks.
layout(early_fragment_tests) in;

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer marks;
  WordBuffer list;
  uint listed, first_leaf, mark;
};

layout(location = 0) in flat uint id;

void main() {
  marks.at[id] = mark;
}
