// What the whole module's World has beside that of `core`: occluders that its objects carry.
import { refuse, said } from './errors.js';
import { Block, calling, expectKind, expectLength, fields, readOrigin } from './memory.js';
import type { Call, Input, Numbers } from './memory.js';
import { sidesNumber, type Sides } from './occlusion.js';
import { buffer, check, need } from './runtime.js';
import { handleList, World as CoreWorld, type Handle, type Handles } from './world.js';

/** The name of an occluder that a world keeps for its objects to carry. */
export type OccluderId = number;
/** The name of none. */
export const noOccluder = 0xffffffff;

/** What hides: triangles, or boxes where there are none, and spheres. All but triangles behind the first `solidTriangles`
 * must lie inside what the objects show; those others are part of it. Metres, in a space of its own. */
export interface Occluder {
  /** Three numbers a position. */
  positions?: Input<Float32Array>;
  /** Three a triangle. */
  indices?: Input<Uint32Array>;
  /** 0: both sides hide; 1: that from which corners turn counter-clockwise. One a triangle, or one for all; none: 0. */
  sides?: Input<Uint8Array>;
  /** So many of the triangles, the first, lie inside; none unless set. */
  solidTriangles?: number;
  /** Minimum and maximum, six numbers a box. */
  boxes?: Input<Float32Array>;
  /** Four columns: centre x, y, z and radius. */
  spheres?: Input<Float32Array>;
}

// Pointers and counts of positions, indices and sides.
function placeMesh(what: string, call: Call, { positions, indices, sides }: Occluder): number[] {
  const [at, points] = column(what, call, 'positions', positions, Float32Array, 3);
  const [index, corners] = column(what, call, 'indices', indices, Uint32Array, 1);
  return [at, points, index, corners, ...column(what, call, 'sides', sides, Uint8Array, 1)];
}

// Where an array lies, and how many elements of so many numbers it has.
function column<T extends Numbers>(what: string, call: Call, name: string, given: Input<T> | undefined,
  kind: Parameters<typeof expectKind<T>>[2], numbers: number): [number, number] {
  if (given === undefined) return [0, 0];
  expectKind(`${what}: ${name}`, given, kind);
  if (given.length % numbers !== 0)
    refuse(`${what}: ${given.length} numbers of ${name}, expected a multiple of ${numbers}`);
  return [call.place(given)[0]!, given.length / numbers];
}

/** A world of boxes, anywhere within 10¹¹ m of 0, whose objects may carry occluders. A refused call changes nothing. */
export class World extends CoreWorld {
  /** Keeps an occluder for objects to carry, as many as like. Some microseconds a triangle. */
  addOccluder(occluder: Occluder): OccluderId {
    return calling((call) => {
      const [positions, indices, sides, solidTriangles = 0, cubes, balls] =
        fields('addOccluder', occluder, ['positions', 'indices', 'sides', 'solidTriangles', 'boxes', 'spheres']);
      if (!Number.isInteger(solidTriangles) || solidTriangles < 0 || solidTriangles > 2 ** 31)
        refuse(`addOccluder: ${said(solidTriangles)} solid triangles, expected as many as there are triangles or fewer`);
      const mesh = placeMesh('addOccluder', call, { positions, indices, sides });
      const boxes = column('addOccluder', call, 'boxes', cubes, Float32Array, 6);
      const spheres = column('addOccluder', call, 'spheres', balls, Float32Array, 4);
      const out = call.room(8);
      check(need('world_add_occluder')(this.pointer, ...mesh, solidTriangles, ...boxes, ...spheres, out));
      return new Float64Array(buffer(), out, 1)[0]!;
    });
  }
  /** Forgets an occluder that no object carries; its name may be used again. */
  removeOccluder(occluder: OccluderId): void {
    check(need('world_remove_occluder')(this.pointer, named('removeOccluder', occluder)));
  }
  /** Gives each object an occluder, switched on, which hides what lies behind it from culls with automatic occlusion.
   * `transforms`: 16 numbers each, column-major and affine, from the occluder's space to metres about the object's origin; the
   * identity unless given. `origins`: three numbers each, or three for all; 0 unless given. Call it again when objects have
   * moved: what reaches out of an object's box is not drawn. `noOccluder` takes away what an object carried. */
  setOccluders(handles: Handles, occluders: OccluderId | Input<Uint32Array>, transforms?: Input<Float32Array>,
    origins?: Input<Float64Array> | readonly [number, number, number]): void {
    calling((call) => {
      const all = handleList(handles), count = all.length;
      const names = typeof occluders === 'number' ? new Uint32Array(count).fill(named('setOccluders', occluders)) : occluders;
      expectKind('setOccluders: occluders', names, Uint32Array);
      expectLength('setOccluders: occluders', names, count);
      if (transforms !== undefined) {
        expectKind('setOccluders: transforms', transforms, Float32Array);
        expectLength('setOccluders: transforms', transforms, 16 * count);
      }
      const from = origins === undefined ? undefined : placeOrigins(origins, count);
      const [numbers, name, matrix, origin] = call.place(all, names, transforms, from);
      check(need('world_set_occluders')(this.pointer, numbers!, name!, matrix!, origin!, count));
    });
  }
  /** Switches what the objects carry on (1, true) or off (0, false), as doors do; those that carry nothing stay so. */
  setOccluding(handles: Handles, on: boolean | Input<Uint8Array>): void {
    calling((call) => {
      const all = handleList(handles);
      const switches = typeof on === 'boolean' ? new Uint8Array(all.length).fill(on ? 1 : 0) : on;
      expectKind('setOccluding', switches, Uint8Array);
      expectLength('setOccluding', switches, all.length);
      const [numbers, at] = call.place(all, switches);
      check(need('world_set_occluding')(this.pointer, numbers!, at!, all.length));
    });
  }
  /** Gives an object its triangles, nine numbers each, in metres about `origin`: all that it shows. Culls with automatic
   * occlusion whose view has the same origin ask for them where the box may be seen; for those of `front` from that side
   * alone: where no view, a shadow map's included, draws their backs. Call it again when the object has moved. None takes them
   * away. */
  setTriangles(handle: Handle, corners: Input<Float32Array>, origin: ArrayLike<number> = [0, 0, 0], sides: Sides = 'both'): void {
    calling((call) => {
      this.expect('setTriangles', handle);
      const [x, y, z] = readOrigin('setTriangles', origin);
      const [at, count] = column('setTriangles', call, 'corners', corners, Float32Array, 3);
      check(need('world_set_triangles')(this.pointer, handle, at, count, x!, y!, z!, sidesNumber('setTriangles', sides)));
    });
  }
}

function named(what: string, occluder: OccluderId): OccluderId {
  if (Number.isInteger(occluder) && occluder >= 0 && occluder <= noOccluder) return occluder;
  return refuse(`${what}: an occluder named ${said(occluder)}, expected what addOccluder returned`);
}

function placeOrigins(origins: Input<Float64Array> | readonly [number, number, number], count: number): Input<Float64Array> {
  if (ArrayBuffer.isView(origins) || Block.is(origins)) {
    expectKind('setOccluders: origins', origins, Float64Array);
    expectLength('setOccluders: origins', origins, 3 * count);
    return origins;
  }
  const origin = readOrigin('setOccluders', origins);
  return Float64Array.from({ length: 3 * count }, (_, i) => origin[i % 3]!);
}
