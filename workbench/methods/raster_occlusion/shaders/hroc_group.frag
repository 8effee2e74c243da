#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/view.h"

#include "boxes.h"
#include "hroc.h"
#include "workbench/device/shaders/frame_depth.h"

// The depth test comes first: only where a group's bounds lie before the occluders is a ray cast. It goes
// through the pixel's centre and marks every object of the group whose box it enters before their depth.
layout(early_fragment_tests) in;
layout(constant_id = 2) const uint kCounts = 0;

layout(location = 0) in flat uint group;
layout(location = 1) in flat vec3 margin;
layout(location = 2) in flat float slack;

struct PixelRay {
  vec3 origin, direction, inverse;
  float depth;  // of the occluders, rounded away from the eye
};

PixelRay ray_through(vec2 pixel) {
  const vec2 at = vec2(2 * pixel.x / view.width - 1, 1 - 2 * pixel.y / view.height);
  PixelRay ray;
  ray.origin = view.ray_origin[0] + at.x * view.ray_origin[1] + at.y * view.ray_origin[2];
  ray.direction = view.ray_direction[0] + at.x * view.ray_direction[1] + at.y * view.ray_direction[2];
  const vec3 direction = mix(ray.direction, vec3(1e-20), lessThan(abs(ray.direction), vec3(1e-20)));
  ray.inverse = 1 / direction;
  const float depth = texelFetch(frame_depth, ivec2(pixel), 0).x, away = 16.0 / 16777216;
  ray.depth = view.reversed != 0 ? depth - away * depth : depth + away;
  return ray;
}

bool lies_before(PixelRay ray, float t) {
  const mat4 m = view.world_to_clip;
  const vec4 at = vec4(ray.origin + t * ray.direction, 1);
  const float z = dot(vec4(m[0].z, m[1].z, m[2].z, m[3].z), at),
              occluder = ray.depth * dot(vec4(m[0].w, m[1].w, m[2].w, m[3].w), at);
  return view.reversed != 0 ? z + slack >= occluder : z - slack <= occluder;
}

bool enters(PixelRay ray, NodeData node) {
  const vec3 a = (node.low - margin - ray.origin) * ray.inverse,
             b = (node.high + margin - ray.origin) * ray.inverse;
  const vec3 low = min(a, b), high = max(a, b);
  const float from = max(max(low.x, low.y), low.z), to = min(min(high.x, high.y), high.z);
  return from <= to && (SIGHTLINE_MUTANT(hroc_by_frustum) ? true : lies_before(ray, from));
}

void main() {
  const NodeData top = nodes.at[group];
  if (top.descendants == 0) {
    marks.at[top.object] = 1;
    return;
  }
  const PixelRay ray = ray_through(gl_FragCoord.xy);
  const uint end = group + 1 + top.descendants;
  uint looked_at = 0;
  for (uint i = group + 1; i < end; ++looked_at) {
    const NodeData node = nodes.at[i];
    const bool entered = enters(ray, node);
    if (entered && node.descendants == 0 &&
        (kContribution != 2 || contributes(boxes.at[node.object].centre_radius, vec3(0)))) {
      marks.at[node.object] = 1;
    }
    i += entered ? 1 : 1 + node.descendants;
  }
  if (kCounts == 0) return;
  atomicAdd(test.rays, 1);
  atomicAdd(test.nodes, looked_at);
}
