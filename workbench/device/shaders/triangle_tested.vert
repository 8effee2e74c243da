#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

// Draws ranges of world-space triangles whose fragments are tested.
layout(push_constant, scalar) uniform Push {
  LookBuffer looks;
  CoordinateBuffer coordinates;
  WordBuffer seen;
};

layout(location = 3) out vec2 coordinate;

#include "workbench/device/shaders/triangle.h"

void main() {
  place_corner();
  coordinate = looks.objects.at[object].image != kNoImage ? coordinates.at[gl_VertexIndex] : vec2(0);
}
