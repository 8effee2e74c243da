// Boxes and the rays of a view, and what of Ye et al. 2023 runs on the CPU.
import { refuse } from '../errors.js';
import { calling, expectKind, expectLength, type Input } from '../memory.js';
import { buffer, check, Owned, wasm } from '../runtime.js';
import { viewBytes, writeView, type View } from '../views.js';

/** What each ray meets first. */
export interface RayHits {
  /** Of equally near boxes the lowest; `noObject` for none. */
  objects: Uint32Array;
  /** Along the ray, in metres; 0 where it starts inside, -1 for a miss. */
  distances: Float32Array;
}

/** Every ray at every box; down a tree; and down a wide tree eight boxes at a time, which is ours. */
export const cpuMethods = ['toca', 'boca', 'wide-rays'] as const;
export type CpuMethod = (typeof cpuMethods)[number];

/** The arrays that web/paper/rays.cpp keeps, in its order. */
const arrays = ['boxes', 'nodes', 'rays', 'objects', 'distances', 'candidates', 'first', 'owners'] as const;
/** Bytes of an element. */
const sizes = { boxes: 24, nodes: 32, rays: 32, objects: 4, distances: 4, candidates: 4, first: 4, owners: 4 };

/** Boxes, the tree of section 2.3 over them, and a grid of rays. */
export class RaySet extends Owned {
  /** Six numbers a box, minimum and maximum, in metres; boxes stop rays. Some 300 ns a box. */
  constructor(boxes: Input<Float32Array>) {
    super('RaySet', 'rays_create', 'rays_destroy');
    try {
      this.update(boxes);
    } catch (error) {
      this.dispose();
      throw error;
    }
  }
  /** Takes other boxes, and builds the tree anew. */
  update(boxes: Input<Float32Array>): void {
    expectKind('RaySet: boxes', boxes, Float32Array);
    if (boxes.length % 6 !== 0) refuse(`RaySet: ${boxes.length} numbers of boxes, expected a multiple of 6`);
    calling((call) => check(wasm().rays_build!(this.pointer, call.place(boxes)[0]!, boxes.length / 6)));
    ++this.version;
  }
  /** Changes whenever the boxes do. */
  version = 0;

  /** columns × rows rays through the middles of as many equal parts of the view's image, row by row from the top. The view
   * has no origin of its own. */
  aim(view: View, columns: number, rows: number): void {
    if (view?.origin && Array.from(view.origin).some((x) => x !== 0)) refuse('aim: expected a view without an origin', 'bad_view');
    for (const count of [columns, rows]) {
      if (!Number.isInteger(count) || count < 1 || count > 4096)
        refuse(`aim: ${columns} x ${rows} rays, expected 1 to 4096 a side`);
    }
    calling((call) => {
      const at = call.room(viewBytes);
      writeView('aim', view, at);
      check(wasm().rays_aim!(this.pointer, at, columns, rows));
    });
  }
  /** Casts the rays here. The arrays are copies; those of `into`, of an element a ray, are filled instead of new ones, so that
   * casting every frame allocates nothing. */
  cast(method: CpuMethod, into?: RayHits): RayHits {
    const number = cpuMethods.indexOf(method);
    if (number < 0) refuse(`cast: a method of ${method}, expected ${cpuMethods.join(', ')}`);
    if (into) {
      const { objects, distances } = into;
      if (!(objects instanceof Uint32Array && distances instanceof Float32Array))
        refuse('cast: into, expected objects as a Uint32Array and distances as a Float32Array');
      for (const column of [objects, distances]) expectLength('cast: into', column, this.rays);
    }
    wasm().rays_cast!(this.pointer, number);
    const objects = new Uint32Array(buffer(), this.#where('objects')[0], this.rays);
    const distances = new Float32Array(buffer(), this.#where('distances')[0], this.rays);
    if (!into) return { objects: objects.slice(), distances: distances.slice() };
    into.objects.set(objects), into.distances.set(distances);
    return into;
  }
  /** The tree laid flat, depth first, 32 bytes a node: minimum, number of descendants (Arr_b), maximum, object or `noObject`.
   * A view of the module's memory, until the next call. */
  get nodes(): Uint8Array {
    return this.bytes('nodes');
  }
  /** Boxes. */
  get size(): number {
    return this.count('boxes');
  }
  /** Rays. */
  get rays(): number {
    return this.count('rays');
  }

  /** @internal Walks the tree: what bvha's GPU is to test. */
  collect(): void {
    wasm().rays_collect!(this.pointer);
  }
  /** @internal */
  count(name: (typeof arrays)[number]): number {
    return this.#where(name)[1];
  }
  /** @internal As it lies in the module, until the next call. */
  bytes(name: (typeof arrays)[number]): Uint8Array<ArrayBuffer> {
    const [at, count] = this.#where(name);
    return new Uint8Array(buffer(), at, count * sizes[name]);
  }
  #where(name: (typeof arrays)[number]): [number, number] {
    return calling((call) => {
      const out = call.room(16 * arrays.length);
      wasm().rays_arrays!(this.pointer, out);
      const found = new Float64Array(buffer(), out + 16 * arrays.indexOf(name), 2);
      return [found[0]!, found[1]!];
    });
  }
}

/** The potentially visible set: every object that a ray met, ascending. */
export function visibleSet(hits: RayHits, objects: number): Uint32Array {
  if (!(hits?.objects instanceof Uint32Array)) refuse('visibleSet: hits, expected those of cast()');
  if (!Number.isInteger(objects) || objects < 0 || objects > 2 ** 31)
    refuse(`visibleSet: ${String(objects)} objects, expected an integer from 0 to 2^31`);
  const seen = new Uint8Array(objects);
  for (const object of hits.objects) if (object < objects) seen[object] = 1;
  const visible = new Uint32Array(seen.reduce((sum, one) => sum + one, 0));
  let count = 0;
  for (let object = 0; object < objects; ++object) if (seen[object]) visible[count++] = object;
  return visible;
}
