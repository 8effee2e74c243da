// Whether depth tiles hide a box: it lies behind the farthest depth of every tile that it touches (Greene et
// al. 1993).
bool hides(float depth, float nearest) {
  return view.reversed != 0 ? nearest < depth : nearest > depth;
}

// Pixels, from the first to the last; none where the last comes before it.
struct PixelRange {
  ivec2 first, last;
};
bool is_empty(PixelRange range) {
  return any(greaterThan(range.first, range.last));
}

// Those in the picture whose middles the footprint may hold: nothing is drawn of a box that holds none.
PixelRange pixels_of(Footprint print) {
  const vec2 size = vec2(image_size());
  return PixelRange(ivec2(ceil(clamp(print.low - 0.5, vec2(0), size))),
                    ivec2(floor(clamp(print.high - 0.5, vec2(-1), size - 1))));
}

// Of a box that touches more, looking costs more than what it spares.
const uint kMostTiles = 1024, kMostPixels = 256;

// Whether some tile leaves a box open that is so near, or nobody knows, as where tiles are not made.
bool tiles_leave_open(PixelRange pixels, float nearest) {
  const uvec2 first = uvec2(pixels.first) / kDepthTile, last = uvec2(pixels.last) / kDepthTile;
  const uvec2 span = last - first + 1;
  const uint columns = tiles_in_image().x;
  const bool made = all(greaterThanEqual(first, kBlock * blocks.xy)) &&
                    all(lessThan(last, kBlock * (blocks.xy + blocks.zw)));
  bool open = span.x * span.y > kMostTiles || !made;
  for (uvec2 tile = first; tile.y <= last.y && !open;) {
    open = !hides(tiles.at[tile.y * columns + tile.x], nearest);
    const bool ends = tile.x == last.x;
    tile = uvec2(ends ? first.x : tile.x + 1, ends ? tile.y + 1 : tile.y);
  }
  return open;
}

// Whether some of a few pixels leaves it open: far away a tile, too, holds many objects and the gaps between
// them.
bool pixels_leave_open(PixelRange pixels, float nearest) {
  const ivec2 span = pixels.last - pixels.first + 1;
  const vec2 scale = 1 / vec2(image_size());
  bool open = span.x * span.y > kMostPixels;
  // Two rows and columns at a time, of an odd number the last ones once more.
  const ivec2 end = max(pixels.last - 1, pixels.first);
  ivec2 at = pixels.first;
  for (bool more = !open; more;) {
    vec4 depths = textureGather(frame_depth, vec2(at + 1) * scale);
    if (span.x == 1) depths.yz = depths.xw;
    if (span.y == 1) depths.xy = depths.wz;
    open = !hides(farthest(depths), nearest);
    more = !open && at != end;
    const bool ends = at.x == end.x;
    at = ivec2(ends ? pixels.first.x : min(at.x + 2, end.x), ends ? min(at.y + 2, end.y) : at.y);
  }
  return open;
}

// Whether the depth so far leaves the box open.
bool leaves_open(Footprint print) {
  if (print.whole) return true;
  const PixelRange pixels = pixels_of(print);
  return !is_empty(pixels) && tiles_leave_open(pixels, print.nearest) &&
         pixels_leave_open(pixels, print.nearest);
}
