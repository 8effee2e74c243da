// One word an object in two-phase methods: the frame that wrote it, and below it these bits. A word of
// another frame counts as 0, so that nothing need be cleared. Tiles after the first word hold the frame
// alone.
const uint kInView = 1;      // passed the frustum and contribution tests
const uint kDrawnEarly = 2;  // was seen last frame: drawn before the occlusion test, if solid
const uint kSeen = 4;        // passed the occlusion test
const uint kEqualDepth = 8;  // shares a tile with an object that was drawn late

uint state_word(uint frame, uint bits) {
  return frame << 4 | bits;
}

uint state_bits(uint frame, uint word) {
  return word >> 4 == frame ? word & 15 : 0;
}

const uint kTile = 64;  // pixels, the side of a tile

uvec2 tile_count() {
  return uvec2(ceil(vec2(view.width, view.height) / kTile));
}

// First and last tile that a box may touch.
void tile_range(Footprint print, out uvec2 first, out uvec2 last) {
  const vec2 edge = vec2(tile_count()) - 1;
  first = uvec2(clamp(floor(print.low / kTile), vec2(0), edge));
  last = uvec2(clamp(floor(print.high / kTile), vec2(0), edge));
}
