// A box against a DepthPyramid: its nearest depth against the farthest depths over its rectangle (Greene et
// al. 1993), in the level where the rectangle is at most three texels wide.
layout(buffer_reference, scalar) readonly buffer FloatBuffer {
  float at[];
};

// Whether the box may have a pixel that the pyramid leaves open.
bool leaves_open(FloatBuffer pyramid, vec3 centre, vec3 half_extent) {
  const Footprint print = footprint(centre, half_extent);
  if (print.whole || reaches_near_plane(centre, half_extent)) return true;
  const uvec2 image = uvec2(view.width, view.height);
  if (any(lessThan(print.high, vec2(0))) || any(greaterThan(print.low, vec2(image)))) return false;
  const uvec2 first = uvec2(clamp(floor(print.low), vec2(0), vec2(image - 1)));
  const uvec2 last = uvec2(clamp(floor(print.high), vec2(0), vec2(image - 1)));
  const uint span = max(last.x - first.x, last.y - first.y);
  const uint level = SIGHTLINE_MUTANT(hiz_mip_too_coarse) ? findMSB(2 * span + 1)
                     : span < 2                           ? 0
                                                          : findMSB(span);
  uint offset = 0;
  uvec2 size = image;
  for (uint i = 0; i < level; ++i) {
    offset += size.x * size.y;
    size = (size + 1) / 2;
  }
  bool open = false;
  for (uint y = first.y >> level; y <= last.y >> level; ++y) {
    for (uint x = first.x >> level; x <= last.x >> level; ++x) {
      const float farthest = pyramid.at[offset + y * size.x + x];
      open = open || (view.reversed != 0 ? print.nearest >= farthest : print.nearest <= farthest);
    }
  }
  return open;
}
