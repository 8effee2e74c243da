// What build/web/rays.bin says that this processor's build answers (web/paper/native_rays.cpp): five models, views, hits.
export function* read(bytes) {
  let at = 0;
  const take = (Kind, count) => {
    const taken = new Kind(bytes.slice(at, at + count * Kind.BYTES_PER_ELEMENT));
    at += count * Kind.BYTES_PER_ELEMENT;
    return taken;
  };
  const [views, side] = take(Uint32Array, 2);
  for (let model = 1; model <= 5; ++model) {
    const [count] = take(Uint32Array, 1), boxes = take(Float32Array, 6 * count), all = [];
    for (let v = 0; v < views; ++v) {
      const view = { worldToEye: take(Float32Array, 16), eyeToClip: take(Float32Array, 16), width: 1280, height: 720 };
      all.push({ view, objects: take(Uint32Array, side * side), distances: take(Float32Array, side * side) });
    }
    yield { model, boxes, side, views: all };
  }
}

/** Rays whose hits differ, to the bit. */
export function differing(hits, { objects, distances }) {
  const a = new Uint32Array(hits.distances.buffer), b = new Uint32Array(distances.buffer);
  let count = hits.objects.length === objects.length ? 0 : objects.length;
  for (let r = 0; r < objects.length; ++r) if (hits.objects[r] !== objects[r] || a[r] !== b[r]) ++count;
  return count;
}
