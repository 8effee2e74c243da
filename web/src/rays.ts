// Boxes to cast rays at, and what they meet first.
import { readBoxes, type Boxes } from './boxes.js';
import { refuse, said } from './errors.js';
import { calling, countOf, expectBlock, expectLength, type Block, type Input } from './memory.js';
import { buffer, check, Owned, pointerOf, wasm } from './runtime.js';
import { readView, writeView, type View } from './views.js';

/** The object of a ray that meets nothing. */
export const noObject = 0xffffffff;

/** A wide tree of boxes; answers are the same to the bit as testing all. */
export class BoxBvh extends Owned {
  constructor() {
    super('BoxBvh', 'bvh_create', 'bvh_destroy');
  }
  /** Takes the boxes; rays and views count from their origin. */
  build(boxes: Boxes): void {
    take(this, 'bvh_build', 'build', boxes);
  }
  /** Takes over moved boxes, as many as were built with. */
  refit(boxes: Boxes): void {
    take(this, 'bvh_refit', 'refit', boxes);
  }
  /** Boxes. */
  get size(): number {
    return wasm().bvh_size!(pointerOf('BoxBvh', this));
  }
  /** Seven numbers a ray: origin, direction, most distance (Infinity for none). Writes the box that each meets first, or
   * noObject, and how far it is in units of the direction, or -1. */
  cast(rays: Input<Float32Array>, objects: Block<Uint32Array>, distances: Block<Float32Array>): void {
    calling((call) => {
      const count = countOf('cast', 'rays', rays, Float32Array, 7);
      expectBlock('cast: objects', objects, Uint32Array);
      expectBlock('cast: distances', distances, Float32Array);
      expectLength('cast: objects', objects, count);
      expectLength('cast: distances', distances, count);
      const [at] = call.place([rays, 7 * count]);
      check(wasm().bvh_cast!(pointerOf('BoxBvh', this), at!, count, objects.pointer, distances.pointer));
    });
  }
  /** The boxes that at least one of columns x rows rays through the view's image meets first, ascending: an approximation
   * of what is visible. */
  visibleSet(view: View, columns: number, rows: number): Uint32Array {
    return calling((call) => {
      const read = readView('visibleSet', view), viewAt = call.room(176), out = call.room(4 * wasm().bvh_size!(pointerOf('BoxBvh', this)));
      writeView(read, viewAt);
      // The module would take them modulo 2^32.
      for (const side of [columns, rows])
        if (!Number.isInteger(side) || side < 1 || side > 2 ** 24)
          refuse(`visibleSet: ${said(columns)} x ${said(rows)} rays, expected 1 to 2^24 of them`);
      check(wasm().bvh_visible_set!(pointerOf('BoxBvh', this), viewAt, columns, rows, out, viewAt + 168));
      return new Uint32Array(buffer(), out, new Float64Array(buffer(), viewAt + 168, 1)[0]!).slice();
    });
  }
}

function take(bvh: BoxBvh, name: string, what: string, boxes: Boxes): void {
  const { data, count, args } = readBoxes(what, boxes), pointer = pointerOf('BoxBvh', bvh);
  if (name === 'bvh_refit' && count !== bvh.size) refuse(`refit: ${count} boxes, expected ${bvh.size}`);
  calling((call) => {
    const [at] = call.place(data);
    check(wasm()[name]!(pointer, ...args(at!)));
  });
}
