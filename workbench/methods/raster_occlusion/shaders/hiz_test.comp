#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "state.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// Frustum and contribution; then the nearest depth of a box against the farthest depths over its rectangle
// (Greene et al. 1993), in the level where the rectangle is at most three texels wide.
layout(buffer_reference, scalar) readonly buffer FloatBuffer { float at[]; };

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer state;
  FloatBuffer pyramid;
  uint objects, frame;
};

// Whether the box may have a pixel that the pyramid leaves open.
bool shows(vec3 centre, vec3 half_extent) {
  const Footprint print = footprint(centre, half_extent);
  if (print.whole || reaches_near_plane(centre, half_extent)) return true;
  const uvec2 image = uvec2(view.width, view.height);
  if (any(lessThan(print.high, vec2(0))) || any(greaterThan(print.low, vec2(image)))) return false;
  const uvec2 first = uvec2(clamp(floor(print.low), vec2(0), vec2(image - 1)));
  const uvec2 last = uvec2(clamp(floor(print.high), vec2(0), vec2(image - 1)));
  const uint span = max(last.x - first.x, last.y - first.y);
  const uint level = SIGHTLINE_MUTANT(hiz_mip_too_coarse) ? findMSB(2 * span + 1) : span < 2 ? 0 : findMSB(span);
  uint offset = 0;
  uvec2 size = image;
  for (uint i = 0; i < level; ++i) {
    offset += size.x * size.y;
    size = (size + 1) / 2;
  }
  for (uint y = first.y >> level; y <= last.y >> level; ++y) {
    for (uint x = first.x >> level; x <= last.x >> level; ++x) {
      const float farthest = pyramid.at[offset + y * size.x + x];
      if (view.reversed != 0 ? print.nearest >= farthest : print.nearest <= farthest) return true;
    }
  }
  return false;
}

void main() {
  const uint object = invocation();
  if (object >= objects) return;
  const BoxData box = boxes.at[object];
  const vec3 centre = box.centre_radius.xyz;
  const vec3 half_extent = widened(centre, box.half_extent.xyz);
  if (outside(centre, half_extent) || !contributes(box.centre_radius, half_extent)) return;
  uint bits = kInView;
  if ((state_bits(frame - 1, state.at[object]) & kSeen) != 0) bits |= kDrawnEarly;
  if (SIGHTLINE_MUTANT(hiz_by_frustum) ? true : shows(centre, half_extent)) bits |= kSeen;
  state.at[object] = state_word(frame, bits);
}
