#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

// Draws an object of the list.
layout(push_constant, scalar) uniform Push {
  ObjectBuffer objects;
  WordBuffer list;
};

#include "workbench/device/shaders/object.h"

void main() {
  place_object();
}
