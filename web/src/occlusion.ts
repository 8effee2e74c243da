// Occluders are drawn into a depth buffer on the CPU, then boxes are tested against it.
import { placeBoxes, type Boxes } from './boxes.js';
import { refuse, said } from './errors.js';
import { calling, countOf, expectBlock, expectLength, isA, readNumbers, readOptions, type Block, type Input } from './memory.js';
import { buffer, check, need, Owned, pointerOf, wasm } from './runtime.js';
import { readView, viewBytes, writeView, type View } from './views.js';

/** From which sides triangles are there: the front is that from which corners turn counter-clockwise. */
export type Sides = 'both' | 'front';
export function sidesNumber(what: string, sides: Sides): number {
  if (sides !== 'both' && sides !== 'front') refuse(`${what}: sides of ${said(sides)}, expected both or front`);
  return sides === 'front' ? 1 : 0;
}

/** Triangles that occlude. What can be looked through must not be among them. */
export class OccluderMesh extends Owned {
  /** Three numbers a position, in metres; three indices a triangle. `front`: only the side from which corners turn
   * counter-clockwise occludes. Some microseconds a triangle: build once. */
  constructor(positions: Input<Float32Array>, indices: Input<Uint32Array>, sides: Sides = 'both') {
    super('OccluderMesh', 'mesh_create', 'mesh_destroy', calling((call) => {
      const points = countOf('OccluderMesh', 'positions', positions, Float32Array, 3, 'bad_mesh');
      const corners = countOf('OccluderMesh', 'indices', indices, Uint32Array, 1);
      const drawn = sidesNumber('OccluderMesh', sides);
      const [at, index] = call.place([positions, 3 * points], [indices, corners]);
      const made = need('mesh_create')(at!, points, index!, corners, drawn);
      if (made === 0) check(wasm().last_code!());
      return made;
    }));
  }
  /** Triangles that are left. */
  get triangles(): number {
    return wasm().mesh_triangles!(pointerOf('OccluderMesh', this));
  }
}

const coverages = ['centres', 'area'] as const;
/** How fine and for which places an OcclusionBuffer answers. */
export interface OcclusionOptions {
  /** `area`, any place on the image, unless told otherwise: antialiasing, jitter, upscaling, another size of canvas; or
   * `centres` of pixels alone, where a canvas without antialiasing takes its one sample: more is hidden, and meshes take
   * about half as long. */
  coverage?: (typeof coverages)[number];
  /** Pixels of the view along a side of one of the buffer's: 1, 2 or 4. */
  scale?: number;
}

/** One view's depth of occluders: begin it with a view, draw occluders, ask. */
export class OcclusionBuffer extends Owned {
  #begun = false;

  constructor() {
    super('OcclusionBuffer', 'occlusion_create', 'occlusion_destroy');
  }
  /** Empties it and takes the view, of at most 8192 pixels a side. */
  begin(view: View, options?: OcclusionOptions): void {
    const [coverage = 'area', scale = 1] = readOptions('begin', options, ['coverage', 'scale']);
    const places = coverages.indexOf(coverage);
    if (places < 0) refuse(`begin: a coverage of ${said(coverage)}, expected ${coverages.join(', ')}`);
    calling((call) => {
      const read = readView('begin', view), at = call.room(viewBytes);
      writeView(read, at);
      check(wasm().occlusion_begin!(pointerOf('OcclusionBuffer', this), at, places, [1, 2, 4].includes(scale) ? scale : 0));
      this.#begun = true;
    });
  }
  /** Draws boxes of which every point inside is solid. */
  drawBoxes(boxes: Boxes): void {
    calling((call) => {
      const { args } = placeBoxes('drawBoxes', call, boxes);
      check(wasm().occlusion_draw_boxes!(pointerOf('OcclusionBuffer', this), ...args));
    });
  }
  /** Draws solid spheres about the view's origin: four columns, centre x, y, z and radius. */
  drawSpheres(spheres: Input<Float32Array>): void {
    calling((call) => {
      const count = countOf('drawSpheres', 'spheres', spheres, Float32Array, 4);
      const [at] = call.place([spheres, 4 * count]);
      check(wasm().occlusion_draw_spheres!(pointerOf('OcclusionBuffer', this), at!, count));
    });
  }
  /** Draws a mesh, moved by an affine matrix about the view's origin. */
  drawMesh(mesh: OccluderMesh, transform: ArrayLike<number>): void {
    if (!isA(mesh, OccluderMesh)) refuse('drawMesh: expected an OccluderMesh');
    const numbers = readNumbers('drawMesh', 'a transform', transform, 16);
    calling((call) => {
      const at = call.room(64);
      new Float32Array(buffer(), at, 16).set(numbers);
      check(wasm().occlusion_draw_mesh!(pointerOf('OcclusionBuffer', this), pointerOf('OccluderMesh', mesh), at));
    });
  }
  /** Whether some place on the image, or pixel centre, may see each box: 1 or 0, where 0 is certain. */
  maySee(boxes: Boxes, out: Block<Uint8Array>): void {
    void pointerOf('OcclusionBuffer', this); // a Proxy of it has nothing that is private
    calling((call) => {
      if (!this.#begun) refuse('maySee: the buffer was never begun, expected begin() first', 'stale_buffer');
      const { count, args } = placeBoxes('maySee', call, boxes);
      expectBlock('maySee: out', out, Uint8Array);
      expectLength('maySee: out', out, count);
      check(wasm().occlusion_may_see!(pointerOf('OcclusionBuffer', this), ...args, out.pointer));
    });
  }
  /** 1 / depth of the occluder at each pixel (perspective), -depth (orthographic), -infinity where there is none; row by
   * row from the top, as many as the view has pixels. */
  readNearness(out: Block<Float32Array>): void {
    expectBlock('readNearness: out', out, Float32Array);
    check(wasm().occlusion_read_nearness!(pointerOf('OcclusionBuffer', this), out.pointer, out.length));
  }
}
