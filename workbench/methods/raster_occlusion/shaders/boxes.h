// What culling shaders ask of a bounding box. Boxes are {centre, half extent}.
#include "library/geometry/mutant.h"

// The contribution test: 0 none, 1 exact, 2 by area. A constant of the pipeline, since llvmpipe computes both
// sides of every branch that is left.
layout(constant_id = 0) const uint kContribution = 0;
layout(constant_id = 1) const float kThreshold = 1;  // px², for area

// Rounding that a plane's value for a box may carry, four times over.
float plane_slack(vec4 plane, vec3 centre, vec3 half_extent) {
  return 1e-6 * (dot(abs(plane.xyz), abs(centre) + half_extent) + min(abs(plane.w), 1e30));
}

bool behind(vec4 plane, vec3 centre, vec3 half_extent) {
  const float nearest = dot(plane.xyz, centre) + plane.w + dot(abs(plane.xyz), half_extent);
  return nearest < -plane_slack(plane, centre, half_extent);
}

bool behind(vec4 plane, vec4 sphere) {
  return dot(plane.xyz, sphere.xyz) + plane.w < -sphere.w - plane_slack(plane, sphere.xyz, vec3(sphere.w));
}

// Whether the box, or the sphere, lies wholly behind a plane of the frustum.
bool outside(vec3 centre, vec3 half_extent) {
  for (int i = 0; i < 6; ++i) {
    if (behind(view.planes[i], centre, half_extent)) return true;
  }
  return false;
}

bool outside(vec4 sphere) {
  for (int i = 0; i < 6; ++i) {
    if (behind(view.planes[i], sphere)) return true;
  }
  return false;
}

// Whether the box reaches the near plane, or the eye is inside: its faces before the plane are clipped, so a
// raster test would not see it. The plane at hand has been pushed towards the eye, so as to drop nothing in
// view.
bool reaches_near_plane(vec3 centre, vec3 half_extent) {
  const vec4 plane = view.planes[4];
  const float nearest = dot(plane.xyz, centre) + plane.w - dot(abs(plane.xyz), half_extent);
  return SIGHTLINE_MUTANT(boxes_at_the_eye_tested)
             ? false
             : nearest <= view.near_push + 4 * plane_slack(plane, centre, half_extent);
}

// The box grown by 1/32 pixel: more than the 1/256 pixel to which the rasteriser snaps vertices, of box and
// mesh alike, so that no pixel of the mesh is missed at the box's rim, nor at a slant in depth. A depth bias
// covers what is left.
vec3 widened(vec3 centre, vec3 half_extent) {
  // A choice of two values and no branch: lavapipe compiles a shader anew at every dispatch if branches on
  // what is uniform are much of it.
  const float farthest =
      dot(view.forward.xyz, centre - view.eye.xyz) + dot(abs(view.forward.xyz), half_extent);
  const float ahead = max(0, farthest), depth = view.eye.w == 0 ? ahead : 1;
  const float pixels = SIGHTLINE_MUTANT(boxes_half_a_pixel_too_small) ? -0.5 : 1.0 / 32;
  return half_extent + pixels * depth / view.pixels_per_metre + 1e-6 * (abs(centre) + half_extent);
}

// Rounding that z and w in clip space may carry, of the box and of what lies in it together. Depth is their
// quotient, and far from the world's origin this is many units of its last place.
float depth_slack(vec3 centre, vec3 half_extent) {
  const mat4 m = view.world_to_clip;
  const vec4 reach = vec4(abs(centre) + half_extent, 1);
  const vec4 z = vec4(m[0].z, m[1].z, m[2].z, m[3].z), w = vec4(m[0].w, m[1].w, m[2].w, m[3].w);
  return SIGHTLINE_MUTANT(boxes_without_depth_bias) ? 0 : 1e-6 * (dot(abs(z), reach) + dot(abs(w), reach));
}

// A point in clip space moved towards the eye by a depth slack, but not across the near plane.
vec4 nearer(vec4 clip, float slack) {
  clip.z =
      view.reversed != 0 ? min(clip.z + slack, max(clip.w, clip.z)) : max(clip.z - slack, min(clip.z, 0));
  return clip;
}

vec4 clip_position(vec3 at, float slack) {
  return nearer(view.world_to_clip * vec4(at, 1), slack);
}

// Of the two faces across an axis, the one that looks at the eye: -1 or 1, 0 where neither does.
float facing(uint axis, vec3 centre, vec3 half_extent) {
  const bool orthographic = view.eye.w > 0;
  const float towards = orthographic ? -view.forward[axis] : view.eye[axis] - centre[axis];
  const float reach = orthographic ? 0 : half_extent[axis];
  return abs(towards) <= reach ? 0 : sign(towards);
}

vec3 corner(vec3 centre, vec3 half_extent, uint bits) {
  return centre +
         half_extent * vec3((bits & 1) != 0 ? 1 : -1, (bits & 2) != 0 ? 1 : -1, (bits & 4) != 0 ? 1 : -1);
}

struct Footprint {
  vec2 low, high;  // pixels, x right, y down, widened by rounding
  float nearest;   // depth, 0 … 1, rounded towards the eye
  bool whole;      // a corner lies at the eye plane: it may be anywhere
};

Footprint footprint(vec3 centre, vec3 half_extent) {
  vec2 low = vec2(1e30), high = vec2(-1e30);
  float nearest = view.reversed != 0 ? 0 : 1, widest = 0;
  const float slack = depth_slack(centre, half_extent);
  for (uint i = 0; i < 8; ++i) {
    const vec4 clip = clip_position(corner(centre, half_extent, i), slack);
    if (!(clip.w > 2 * view.coordinate_error))
      return Footprint(vec2(0), vec2(view.width, view.height), 0, true);
    const vec3 at = clip.xyz / clip.w;
    low = min(low, at.xy);
    high = max(high, at.xy);
    nearest = view.reversed != 0 ? max(nearest, at.z) : min(nearest, at.z);
    widest = max(widest, 2 * view.coordinate_error / clip.w * (1 + max(abs(at.x), abs(at.y))));
  }
  const vec2 half_size = 0.5 * vec2(view.width, view.height);
  const vec2 rim = SIGHTLINE_MUTANT(rectangles_without_rim) ? vec2(-0.5) : widest * half_size + 1.0 / 64;
  const vec2 a = (vec2(low.x, -high.y) + 1) * half_size - rim,
             b = (vec2(high.x, -low.y) + 1) * half_size + rim;
  const float away = 16.0 / 16777216;
  nearest = view.reversed != 0 ? nearest + away * nearest : nearest - away;
  return Footprint(a, b, nearest, false);
}

// Whether the rectangle, clipped to the image, holds a pixel centre.
bool covers_sample(Footprint print) {
  const vec2 size = vec2(view.width, view.height);
  const vec2 low = max(print.low, vec2(0)), high = min(print.high, size);
  return all(greaterThanEqual(floor(high + 0.5) - 0.5, low)) && all(greaterThanEqual(high, vec2(0.5)));
}

// Lee & Shin 2023, equation (1) with its misprint mended, px².
float projected_area(vec4 sphere) {
  float d = 1;
  if (view.eye.w == 0) {
    d = distance(view.eye.xyz, sphere.xyz);
    if (d <= sphere.w) return 1e30;
  }
  const float radius = sphere.w * view.pixels_per_metre / d;
  return 3.14159265 * radius * radius;
}

// Contribution culling, as the method was asked for it.
bool contributes(vec4 sphere, vec3 half_extent) {
  if (kContribution == 1) return covers_sample(footprint(sphere.xyz, half_extent));
  if (kContribution == 2) return projected_area(sphere) >= kThreshold;
  return true;
}

// The nearest there is, where a fault has nothing hide a box.
vec4 before_all(vec4 clip) {
  return vec4(clip.xy, view.reversed != 0 ? clip.w : 0, clip.w);
}

// A corner of a square about the image's middle at the near plane, for boxes that must be marked without a
// raster test: nothing can hide it.
vec4 certain_mark(uint bits) {
  const vec2 at = vec2((bits & 1) != 0 ? 2 : -2, (bits & 2) != 0 ? 2 : -2) / vec2(view.width, view.height);
  return vec4(at, view.reversed, 1);
}

// Where all corners of what is not drawn are put: in view, so that nothing need be clipped.
const vec4 kNowhere = vec4(0, 0, 0.5, 1);
