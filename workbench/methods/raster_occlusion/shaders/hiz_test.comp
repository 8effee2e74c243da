#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "pyramid_test.h"
#include "state.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// Frustum and contribution; then the box against the pyramid.
layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer state;
  FloatBuffer pyramid;
  uint objects, frame;
};

void main() {
  const uint object = invocation();
  if (object >= objects) return;
  const BoxData box = boxes.at[object];
  const vec3 centre = box.centre_radius.xyz;
  const vec3 half_extent = widened(centre, box.half_extent.xyz);
  if (outside(centre, half_extent) || !contributes(box.centre_radius, half_extent)) return;
  uint bits = kInView;
  if ((state_bits(frame - 1, state.at[object]) & kSeen) != 0) bits |= kDrawnEarly;
  if (SIGHTLINE_MUTANT(hiz_by_frustum) ? true : leaves_open(pyramid, centre, half_extent)) bits |= kSeen;
  state.at[object] = state_word(frame, bits);
}
