#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "state.h"

// Of a box in the list, the faces that look at the eye: at most three, 18 vertices.
layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer state;
  WordBuffer list;
  uint across_edge;  // 0: the boxes lie wholly in the picture
};

layout(location = 0) out flat uint id;
layout(location = 1) out flat uint seen;

const uint kSquare[6] = uint[](0, 1, 2, 2, 1, 3);

void main() {
  const uint turn = gl_VertexIndex % 18, axis = turn / 6, square = kSquare[turn % 6];
  id = list.at[gl_VertexIndex / 18];
  seen = state.at[id] | kSeen;
  const BoxData box = boxes.at[id];
  const vec3 centre = box.centre_radius.xyz;
  const vec3 half_extent = widened(centre, box.half_extent.xyz);
  const float towards = facing(axis, centre, half_extent);
  vec3 side;
  side[axis] = towards;
  side[(axis + 1) % 3] = (square & 1) != 0 ? 1 : -1;
  side[(axis + 2) % 3] = (square & 2) != 0 ? 1 : -1;
  const vec4 at = clip_position(centre + half_extent * side, depth_slack(centre, half_extent));
  // llvmpipe runs a few lanes more than there are vertices, on whatever was there before, and clips a whole batch
  // once one of them is out of view.
  const bool stray = across_edge == 0 && any(greaterThan(abs(at.xy), vec2(at.w)));
  const bool left_out = SIGHTLINE_MUTANT(resident_chunk_without_a_face) ? axis == 1 : towards == 0;
  gl_Position = left_out || stray ? kNowhere : at;
}
