#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

// Draws ranges of world-space triangles.
#include "workbench/device/shaders/triangle.h"

void main() {
  place_corner();
}
