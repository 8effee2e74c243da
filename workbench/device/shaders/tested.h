// What of an object is drawn: from its drawn side, where its alpha is great enough.
bool shows_side(uint look) {
  if ((look & kFrontOnly) == 0) return true;
  return gl_FrontFacing != ((look & kMirrored) != 0);
}

bool shows_texel(ObjectData data, vec2 coordinate, LookBuffer looks) {
  if ((data.look & kCutOut) == 0 || data.image == kNoImage) return true;
  const ImageData image = looks.images.at[data.image];
  const vec2 size = vec2(image.width, image.height);
  const uvec2 texel = min(uvec2(fract(coordinate) * size), uvec2(image.width, image.height) - 1);
  const uint at = image.first + texel.y * image.width + texel.x;
  return (looks.alpha.at[at / 4] >> 8 * (at % 4) & 255) >= data.look >> kCutoffShift;
}
