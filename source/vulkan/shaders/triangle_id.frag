#version 460
#include "vulkan/shared.h"

layout(push_constant, scalar) uniform Push {
  ObjectBuffer objects;
  PositionBuffer positions;
  WordBuffer owners;
};

layout(location = 1) in flat uint first_triangle;
layout(location = 0) out uint id;

void main() {
  id = owners.at[first_triangle + gl_PrimitiveID];
}
