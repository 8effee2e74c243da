// Boxes and the rays of a view, and what of Ye et al. 2023 runs on the CPU.
import { refuse, said } from '../errors.js';
import { calling, countOf, expectLength, fields, lengthOf, type Input } from '../memory.js';
import { buffer, check, Owned, pointerOf, wasm } from '../runtime.js';
import { noObject } from '../rays.js';
import { readView, viewBytes, writeView, type View } from '../views.js';

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
    const count = countOf('RaySet', 'boxes', boxes, Float32Array, 6);
    calling((call) => check(wasm().rays_build!(pointerOf('RaySet', this), call.place([boxes, 6 * count])[0]!, count)));
    ++this.version;
  }
  /** Changes whenever the boxes do. */
  version = 0;

  /** columns × rows rays through the middles of as many equal parts of the view's image, row by row from the top. The view
   * has no origin of its own. */
  aim(view: View, columns: number, rows: number): void {
    const read = readView('aim', view);
    if (read.origin.some((x) => x !== 0)) refuse('aim: expected a view without an origin', 'bad_view');
    for (const count of [columns, rows]) {
      if (!Number.isInteger(count) || count < 1 || count > 4096)
        refuse(`aim: ${said(columns)} x ${said(rows)} rays, expected 1 to 4096 a side`);
    }
    calling((call) => {
      const at = call.room(viewBytes);
      writeView(read, at);
      check(wasm().rays_aim!(pointerOf('RaySet', this), at, columns, rows));
    });
  }
  /** Casts the rays here. The arrays are copies; those of `into`, of an element a ray, are filled instead of new ones, so that
   * casting every frame allocates nothing. */
  cast(method: CpuMethod, into?: RayHits): RayHits {
    void pointerOf('RaySet', this);
    const number = cpuMethods.indexOf(method);
    if (number < 0) refuse(`cast: a method of ${said(method)}, expected ${cpuMethods.join(', ')}`);
    const given = into && fields('cast: into', into, ['objects', 'distances']);
    const fits = () => {
      if (!given) return;
      if (!(given.every(ArrayBuffer.isView) && given[0] instanceof Uint32Array && given[1] instanceof Float32Array))
        refuse('cast: into, expected objects as a Uint32Array and distances as a Float32Array');
      for (const column of given) expectLength('cast: into', column!, this.rays);
    };
    fits();
    wasm().rays_cast!(pointerOf('RaySet', this), number);
    fits(); // the module's memory may have grown, and they may lie there
    const { rays } = this;
    const objects = new Uint32Array(buffer(), where(this, 'objects')[0], rays);
    const distances = new Float32Array(buffer(), where(this, 'distances')[0], rays);
    if (!into || !given) return { objects: objects.slice(), distances: distances.slice() };
    given[0]!.set(objects), given[1]!.set(distances);
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
    wasm().rays_collect!(pointerOf('RaySet', this));
  }
  /** @internal */
  count(name: (typeof arrays)[number]): number {
    return where(this, name)[1];
  }
  /** @internal As it lies in the module, until the next call. */
  bytes(name: (typeof arrays)[number]): Uint8Array<ArrayBuffer> {
    const [at, count] = where(this, name);
    return new Uint8Array(buffer(), at, count * sizes[name]);
  }
}

// Where an array begins, and how many elements it has.
function where(set: RaySet, name: (typeof arrays)[number]): [number, number] {
  return calling((call) => {
    const out = call.room(16 * arrays.length);
    wasm().rays_arrays!(pointerOf('RaySet', set), out);
    const found = new Float64Array(buffer(), out + 16 * arrays.indexOf(name), 2);
    return [found[0]!, found[1]!];
  });
}

/** The potentially visible set: every object that a ray met, ascending. */
export function visibleSet(hits: RayHits, objects: number): Uint32Array {
  const [met] = fields('visibleSet', hits, ['objects']);
  if (!(ArrayBuffer.isView(met) && met instanceof Uint32Array)) refuse('visibleSet: hits, expected those of cast()');
  if (!Number.isInteger(objects) || objects < 0 || objects > 2 ** 31)
    refuse(`visibleSet: ${said(objects)} objects, expected an integer from 0 to 2^31`);
  const rays = lengthOf(met);
  let most = -1;
  for (let i = 0; i < rays; ++i) if (met[i] !== noObject && met[i]! > most) most = met[i]!;
  if (most >= objects) refuse(`visibleSet: hits of object ${most}, expected those of ${objects} objects`);
  // A bit an object, up to the last that was met: `objects` may be any number.
  const marks = new Uint32Array(Math.ceil((most + 1) / 32));
  let count = 0;
  for (let i = 0; i < rays; ++i) {
    const id = met[i]!, word = id >>> 5, bit = 1 << (id & 31);
    if (id !== noObject && (marks[word]! & bit) === 0) marks[word]! |= bit, ++count;
  }
  const visible = new Uint32Array(count);
  let at = 0;
  for (let word = 0; word < marks.length; ++word)
    for (let bits = marks[word]!; bits !== 0; bits &= bits - 1) visible[at++] = 32 * word + 31 - Math.clz32(bits & -bits);
  return visible;
}
