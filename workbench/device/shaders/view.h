// The frame's view; uniform, so that its values are fetched once for all lanes.
layout(set = 0, binding = 0, scalar) uniform ViewBlock {
  ViewData view;
};

// How far before the far plane, in metres: what lies beyond is not drawn. Depth alone cannot tell where near
// and far are far apart.
float before_far_end(vec3 at) {
  return dot(view.far_end.xyz, at) + view.far_end.w;
}

// Where the point goes in clip space, put on the grid of 1/256 pixel to which rasterisers snap vertices.
// Coverage is decided on that grid; a rasteriser that takes the slope of depth from positions off it, as
// llvmpipe does, extrapolates far beyond a triangle seen edge on, even to the near plane, and no box would
// hold what it draws.
vec4 on_pixel_grid(vec3 at) {
  const vec4 clip = view.world_to_clip * vec4(at, 1);
  const vec2 half_size = 128 * vec2(view.width, view.height);
  const vec2 snapped = round(clip.xy / clip.w * half_size) / half_size;
  const bool fine = clip.w > 0 && all(lessThan(abs(snapped), vec2(64)));
  return fine ? vec4(snapped * clip.w, clip.zw) : clip;
}
