#version 460
#include "vulkan/shared.h"

layout(push_constant, scalar) uniform Push {
  ViewBuffer view;
  ObjectBuffer objects;
  PositionBuffer positions;
  WordBuffer owners;
};

layout(location = 0) in vec3 world_position;
layout(location = 1) in flat uint first_triangle;
layout(location = 0) out vec4 shade;

void main() {
  const vec4 base = unpackUnorm4x8(objects.at[owners.at[first_triangle + gl_PrimitiveID]].colour);
  const vec3 to_eye = view.view.eye.w > 0 ? -view.view.forward.xyz : view.view.eye.xyz - world_position;
  vec3 n = cross(dFdx(world_position), dFdy(world_position));  // flat: of the triangle itself
  n *= inversesqrt(max(dot(n, n), 1e-30));
  if (dot(n, to_eye) < 0) n = -n;
  const vec3 sun = normalize(vec3(0.45, 0.75, 0.5));
  const vec3 sky = mix(vec3(0.30, 0.27, 0.25), vec3(0.50, 0.58, 0.70), 0.5 + 0.5 * n.y);
  shade = vec4(base.rgb * (sky + vec3(0.95, 0.88, 0.75) * max(dot(n, sun), 0)), base.a);
}
