#version 460
#include "vulkan/shared.h"

#include "vulkan/shaders/view.h"

#include "boxes.h"
#include "state.h"
layout(local_size_x = 96) in;

// One group a chunk that is in, one invocation an object: frustum and contribution; what is left is tested
// for occlusion, but for boxes at the near plane, which are seen untested.
#include "resident.h"

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer marks;
  WordBuffer candidates;
  WordBuffer state;
  WordBuffer chunks_in;  // number of the chunk, bit 31: wholly in the frustum
  WordBuffer chunk_objects;  // 97 words a chunk: how many, ids
  TestBuffer test;
  uint frame;
};

void main() {
  const uint entry = chunks_in.at[gl_WorkGroupID.x];
  const uint chunk = 97 * (entry & 0x7fffffff);
  if (gl_LocalInvocationID.x >= chunk_objects.at[chunk]) return;
  const uint object = chunk_objects.at[chunk + 1 + gl_LocalInvocationID.x];
  const BoxData box = boxes.at[object];
  const vec3 centre = box.centre_radius.xyz;
  const vec3 half_extent = widened(centre, box.half_extent.xyz);
  if ((entry & 0x80000000) == 0 && outside(centre, half_extent)) return;
  if (!contributes(box.centre_radius, half_extent)) return;
  const bool drawn = marks.at[object] == frame - 1;
  state.at[object] = state_word(frame, drawn ? kInView | kDrawnEarly : kInView);
  if (reaches_near_plane(centre, half_extent)) {
    marks.at[object] = frame;
  } else {
    candidates.at[atomicAdd(test.candidates, 1)] = object;
  }
}
