// What the ray shaders share: their arrays, and the slab test of include/sightline/rays.hpp, operation for
// operation, so that every hit is the CPU's to the bit. `precise` forbids fused multiply-adds.
struct RayData {
  vec3 origin;
  float max_distance;
  vec3 inverse;  // 0 on an axis that the ray is parallel to
  float pad;
};
struct BoxSpan {
  vec3 low, high;
};
struct NodeData {
  vec3 low;
  uint descendants;
  vec3 high;
  uint object;
};
struct Hit {
  uint object;
  float distance;
};
const uint kNoObject = 0xffffffffu;

layout(buffer_reference, scalar) readonly buffer RayBuffer {
  RayData at[];
};
layout(buffer_reference, scalar) readonly buffer BoxSpanBuffer {
  BoxSpan at[];
};
layout(buffer_reference, scalar) readonly buffer NodeBuffer {
  NodeData at[];
};
layout(buffer_reference, scalar) buffer HitBuffer {
  Hit at[];
};
layout(buffer_reference, scalar) buffer DistanceBuffer {
  float at[];
};

bool clip(float origin, float inverse, float low, float high, inout float entry, inout float exit) {
  if (inverse == 0) return origin >= low && origin <= high;
  precise float from_low = low - origin, from_high = high - origin;
  precise float a = from_low * inverse, b = from_high * inverse;
  float first = a < b ? a : b, last = a < b ? b : a;
  entry = first > entry ? first : entry;
  exit = last < exit ? last : exit;
  return entry <= exit;
}

float intersect_box(RayData ray, vec3 low, vec3 high) {
  float entry = 0, exit = ray.max_distance;
  if (!clip(ray.origin.x, ray.inverse.x, low.x, high.x, entry, exit)) return -1;
  if (!clip(ray.origin.y, ray.inverse.y, low.y, high.y, entry, exit)) return -1;
  if (!clip(ray.origin.z, ray.inverse.z, low.z, high.z, entry, exit)) return -1;
  return entry;
}

// The same without a branch: what one slab decides, no later one undoes.
void clip_flat(float origin, float inverse, float low, float high, inout float entry, inout float exit,
               inout bool inside) {
  const bool parallel = inverse == 0;
  precise float from_low = low - origin, from_high = high - origin;
  precise float a = from_low * inverse, b = from_high * inverse;
  const float first = a < b ? a : b, last = a < b ? b : a;
  entry = !parallel && first > entry ? first : entry;
  exit = !parallel && last < exit ? last : exit;
  inside = inside && (!parallel || (origin >= low && origin <= high));
}

float intersect_box_flat(RayData ray, vec3 low, vec3 high) {
  float entry = 0, exit = ray.max_distance;
  bool inside = true;
  clip_flat(ray.origin.x, ray.inverse.x, low.x, high.x, entry, exit, inside);
  clip_flat(ray.origin.y, ray.inverse.y, low.y, high.y, entry, exit, inside);
  clip_flat(ray.origin.z, ray.inverse.z, low.z, high.z, entry, exit, inside);
  return inside && entry <= exit ? entry : -1;
}

// Of equally near objects the lower id.
void offer(inout Hit nearest, float t, uint object) {
  if (t < 0) return;
  if (nearest.object == kNoObject || t < nearest.distance ||
      (t == nearest.distance && object < nearest.object)) {
    nearest.object = object;
    nearest.distance = t;
  }
}
