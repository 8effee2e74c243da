#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// Frustum and contribution of this frame; then the box as last frame's camera saw it, against last frame's
// depth, in four texels of the level that the rectangle's larger side asks for.
layout(buffer_reference, scalar) readonly buffer FloatBuffer { float at[]; };
layout(buffer_reference, scalar) readonly buffer LastView { ViewData view; };

layout(push_constant, scalar) uniform Push {
  BoxBuffer boxes;
  WordBuffer marks;
  FloatBuffer pyramid;
  LastView last;
  uint objects, has_last;
};

bool shows(vec3 centre, vec3 half_extent) {
  const ViewData then = last.view;
  const bool reversed = then.reversed != 0;
  vec2 low = vec2(1), high = vec2(-1);
  float nearest = reversed ? 0 : 1;
  for (uint i = 0; i < 8; ++i) {
    const vec4 clip = then.world_to_clip * vec4(corner(centre, half_extent, i), 1);
    if (clip.w <= 0) return true;
    const vec3 at = clip.xyz / clip.w;
    low = i == 0 ? at.xy : min(low, at.xy);
    high = i == 0 ? at.xy : max(high, at.xy);
    nearest = reversed ? max(nearest, at.z) : min(nearest, at.z);
  }
  const uvec2 image = uvec2(then.width, then.height);
  const vec2 a = (vec2(low.x, -high.y) + 1) * 0.5 * vec2(image),
             b = (vec2(high.x, -low.y) + 1) * 0.5 * vec2(image);
  if (any(lessThan(b, vec2(0))) || any(greaterThan(a, vec2(image)))) return true;  // it was out of view then
  const uvec2 first = uvec2(clamp(floor(a), vec2(0), vec2(image - 1)));
  const uvec2 last_pixel = uvec2(clamp(floor(b), vec2(0), vec2(image - 1)));
  const uint span = max(last_pixel.x - first.x, last_pixel.y - first.y);
  const uint level = span < 1 ? 0 : findMSB(span);
  uint offset = 0;
  uvec2 size = image;
  for (uint i = 0; i < level; ++i) {
    offset += size.x * size.y;
    size = (size + 1) / 2;
  }
  for (uint i = 0; i < 4; ++i) {
    const uvec2 texel = min((first >> level) + uvec2(i & 1, i >> 1), size - 1);
    const float farthest = pyramid.at[offset + texel.y * size.x + texel.x];
    if (reversed ? nearest >= farthest : nearest <= farthest) return true;
  }
  return false;
}

void main() {
  const uint object = invocation();
  if (object >= objects) return;
  const BoxData box = boxes.at[object];
  const vec3 centre = box.centre_radius.xyz, half_extent = box.half_extent.xyz;
  if (outside(centre, half_extent) || !contributes(box.centre_radius, half_extent)) return;
  if (has_last == 0 || shows(centre, half_extent)) marks.at[object] = 1;
}
