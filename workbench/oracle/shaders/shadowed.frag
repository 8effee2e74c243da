#version 460
#include "workbench/device/shared.h"

#include "workbench/device/shaders/tested.h"

layout(buffer_reference, scalar) readonly buffer DepthBuffer {
  float at[];
};
layout(buffer_reference, scalar) readonly buffer MapBuffer {
  mat4 world_to_clip;
  vec4 light;  // where it is, or with w = 0 whither it lies
  float pixels, metres;
  int reach, padding;
  DepthBuffer depth;
};

layout(push_constant, scalar) uniform Push {
  ObjectBuffer objects;
  WordBuffer list;
  LookBuffer looks;
  MapBuffer map;
};

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in flat uint object;
layout(location = 3) in flat uint colour;
layout(location = 4) in vec2 coordinate;
layout(location = 0) out vec4 shade;

// How many of the texels around the one that a point falls into have nothing nearer to the light. Beside its
// map the sun shines, and a spot does not.
uint lit_texels(vec3 at) {
  const vec4 clip = map.world_to_clip * vec4(at, 1);
  if (clip.w <= 0) return 0;
  const vec3 place = clip.xyz / clip.w;
  const vec2 texel = floor((0.5 + vec2(0.5, -0.5) * place.xy) * map.pixels);
  uint lit = 0;
  for (int y = -map.reach; y <= map.reach; ++y) {
    for (int x = -map.reach; x <= map.reach; ++x) {
      const vec2 asked = texel + vec2(x, y);
      const bool outside = any(lessThan(asked, vec2(0))) || any(greaterThanEqual(asked, vec2(map.pixels)));
      if (outside) lit += map.light.w == 0 ? 1 : 0;
      else lit += place.z <= map.depth.at[uint(asked.y) * uint(map.pixels) + uint(asked.x)] ? 1 : 0;
    }
  }
  return lit;
}

void main() {
  const ObjectData data = objects.at[object];
  if (!shows_side(data.look) || !shows_texel(data, coordinate, looks)) discard;
  const vec3 to_light = normalize(map.light.xyz - map.light.w * world_position);
  const float steepness = dot(world_normal, world_normal);
  vec3 n = steepness > 0 ? world_normal * inversesqrt(steepness) : to_light;
  if (dot(n, to_light) < 0) n = -n;  // leaves are lit through
  const uint lit = lit_texels(world_position + map.metres * n);
  const float share = float(lit) / float((2 * map.reach + 1) * (2 * map.reach + 1));
  const vec3 light = vec3(0.35, 0.39, 0.45) + vec3(0.95, 0.88, 0.75) * share * dot(n, to_light);
  shade = vec4(unpackUnorm4x8(colour).rgb * light, float(lit) / 255);
}
