#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

// Draws an object of the list whose fragments are tested.
layout(push_constant, scalar) uniform Push {
  ObjectBuffer objects;
  WordBuffer list;
  LookBuffer looks;
};

layout(location = 4) out vec2 coordinate;

#include "workbench/device/shaders/object.h"

void main() {
  place_object();
  coordinate = objects.at[object].image != kNoImage ? looks.coordinates.at[gl_VertexIndex] : vec2(0);
}
