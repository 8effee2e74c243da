// Whether depth tiles hide a box: it lies behind the farthest depth of every tile that it touches (Greene et
// al. 1993).
bool hides(float depth, float nearest) {
  return view.reversed != 0 ? nearest < depth : nearest > depth;
}

// Of a box that touches more, looking costs more than what it spares.
const uint kMostTiles = 1024;

// Whether some tile of the footprint leaves it open, or nobody knows, as where tiles are not made. Beside the
// picture there are none.
bool tiles_leave_open(Footprint print) {
  const vec2 image = vec2(image_size());
  if (print.whole) return true;
  if (any(lessThan(print.high, vec2(0))) || any(greaterThan(print.low, image))) return false;
  const uvec2 edge = tiles_in_image() - 1;
  const uvec2 first = min(uvec2(max(print.low, vec2(0))) / kDepthTile, edge);
  const uvec2 last = min(uvec2(min(print.high, image)) / kDepthTile, edge), span = last - first + 1;
  const uint columns = tiles_in_image().x;
  const bool made = all(greaterThanEqual(first, kBlock * blocks.xy)) &&
                    all(lessThan(last, kBlock * (blocks.xy + blocks.zw)));
  bool open = span.x * span.y > kMostTiles || !made;
  for (uvec2 tile = first; tile.y <= last.y && !open;) {
    open = !hides(tiles.at[tile.y * columns + tile.x], print.nearest);
    const bool ends = tile.x == last.x;
    tile = uvec2(ends ? first.x : tile.x + 1, ends ? tile.y + 1 : tile.y);
  }
  return open;
}
