// One word an object in two-phase methods.
const uint kInView = 1;       // passed the frustum and contribution tests
const uint kDrawnEarly = 2;   // and was visible last frame: drawn before the occlusion test
const uint kSeen = 4;         // passed the occlusion test
const uint kTied = 8;         // shares a tile with an object that was drawn late

const uint kTile = 64;  // pixels, the side of a tile

uvec2 tile_count(ViewData view) {
  return uvec2(ceil(vec2(view.width, view.height) / kTile));
}

// First and last tile that a box may touch.
void tile_range(ViewData view, Footprint print, out uvec2 first, out uvec2 last) {
  const vec2 edge = vec2(tile_count(view)) - 1;
  first = uvec2(clamp(floor(print.low / kTile), vec2(0), edge));
  last = uvec2(clamp(floor(print.high / kTile), vec2(0), edge));
}
