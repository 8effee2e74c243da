#version 460
#include "workbench/device/shared.h"
#include "library/geometry/mutant.h"
layout(local_size_x = 256) in;
#include "workbench/device/shaders/invocation.h"

// One level of the depth pyramid: the farthest of up to four depths below.
layout(buffer_reference, scalar) buffer FloatBuffer { float at[]; };

layout(push_constant, scalar) uniform Push {
  FloatBuffer from, to;
  uvec2 from_size, to_size;
  uint reversed;
};

void main() {
  const uint i = invocation();
  if (i >= to_size.x * to_size.y) return;
  const uvec2 at = uvec2(i % to_size.x, i / to_size.x);
  const uvec2 low = 2 * at, high = min(low + 1, from_size - 1);
  const float a = from.at[low.y * from_size.x + low.x], b = from.at[low.y * from_size.x + high.x];
  const float c = from.at[high.y * from_size.x + low.x], d = from.at[high.y * from_size.x + high.x];
  to.at[i] = (SIGHTLINE_MUTANT(hiz_of_the_nearest) ? reversed == 0 : reversed != 0) ? min(min(a, b), min(c, d)) : max(max(a, b), max(c, d));
}
