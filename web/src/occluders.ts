// What the whole module's World has beside that of `core`: occluders that its objects carry.
import { refuse, said } from './errors.js';
import { Block, calling, countOf, expectColumn, lengthOf, readOptions, readOrigin } from './memory.js';
import type { Input, Numbers } from './memory.js';
import { sidesNumber, type Sides } from './occlusion.js';
import { buffer, check, need, pointerOf } from './runtime.js';
import { expectObject, handleList, World as CoreWorld, type Handle, type Handles } from './world.js';

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

// How many elements of so many numbers an array has, if there is one.
const countIn = <T extends Numbers>(name: string, given: Input<T> | undefined, kind: Parameters<typeof countOf<T>>[3], numbers: number): number =>
  given === undefined ? 0 : countOf('addOccluder', name, given, kind, numbers);

/** A world of boxes, anywhere within 10¹¹ m of 0, whose objects may carry occluders. A refused call changes nothing. */
export class World extends CoreWorld {
  /** Keeps an occluder for objects to carry, as many as like. Some microseconds a triangle. */
  addOccluder(occluder: Occluder): OccluderId {
    return calling((call) => {
      const [positions, indices, sides, solidTriangles = 0, boxes, spheres] =
        readOptions('addOccluder', occluder, ['positions', 'indices', 'sides', 'solidTriangles', 'boxes', 'spheres']);
      const triangles = positions !== undefined;
      if (triangles !== (indices !== undefined) || (sides !== undefined && !triangles) || !(triangles || boxes || spheres))
        refuse('addOccluder: expected positions with indices, boxes or spheres');
      if (!Number.isInteger(solidTriangles) || solidTriangles < 0 || solidTriangles > 2 ** 31)
        refuse(`addOccluder: ${said(solidTriangles)} solid triangles, expected as many as there are triangles or fewer`);
      const points = countIn('positions', positions, Float32Array, 3), corners = countIn('indices', indices, Uint32Array, 1);
      const faces = countIn('sides', sides, Uint8Array, 1), cubes = countIn('boxes', boxes, Float32Array, 6);
      const balls = countIn('spheres', spheres, Float32Array, 4), counts = [points, corners, faces, cubes, balls];
      // All at once: placing one may have the memory grow, which takes the next away.
      const columns = call.place([positions, 3 * points], [indices, corners], [sides, faces], [boxes, 6 * cubes], [spheres, 4 * balls])
        .flatMap((at, i) => [at, counts[i]!]);
      const out = call.room(8);
      check(need('world_add_occluder')(pointerOf('World', this), ...columns.slice(0, 6), solidTriangles, ...columns.slice(6), out));
      return new Float64Array(buffer(), out, 1)[0]!;
    });
  }
  /** Forgets an occluder that no object carries; its name may be used again. */
  removeOccluder(occluder: OccluderId): void {
    check(need('world_remove_occluder')(pointerOf('World', this), named('removeOccluder', occluder)));
  }
  /** Gives each object an occluder, switched on, which hides what lies behind it from culls with automatic occlusion.
   * `transforms`: 16 numbers each, column-major and affine, from the occluder's space to metres about its entry of `origins`; the
   * identity unless given. `origins`: three numbers each, or three for all; 0 unless given. Call it again when objects have
   * moved, behind `move`, or have turned: of one whose box is another one than it was then, nothing is drawn, nor is what reaches
   * out of that box. `noOccluder` takes away what an object carried. */
  setOccluders(handles: Handles, occluders: OccluderId | Input<Uint32Array>, transforms?: Input<Float32Array>,
    origins?: Input<Float64Array> | readonly [number, number, number]): void {
    calling((call) => {
      const all = handleList(handles), count = lengthOf(all);
      const names = typeof occluders === 'number' ? new Uint32Array(count).fill(named('setOccluders', occluders)) : occluders;
      expectColumn('setOccluders: occluders', names, Uint32Array, count);
      if (transforms !== undefined) expectColumn('setOccluders: transforms', transforms, Float32Array, 16 * count);
      const from = origins === undefined ? undefined : placeOrigins(origins, count);
      const [numbers, name, matrix, origin] = call.place([all, count], [names, count], [transforms, 16 * count], [from, 3 * count]);
      check(need('world_set_occluders')(pointerOf('World', this), numbers!, name!, matrix!, origin!, count));
    });
  }
  /** Switches what the objects carry on (1, true) or off (0, false), as doors do; those that carry nothing stay so. */
  setOccluding(handles: Handles, on: boolean | Input<Uint8Array>): void {
    calling((call) => {
      const all = handleList(handles), count = lengthOf(all);
      const switches = typeof on === 'boolean' ? new Uint8Array(count).fill(on ? 1 : 0) : on;
      expectColumn('setOccluding', switches, Uint8Array, count);
      const [numbers, at] = call.place([all, count], [switches, count]);
      check(need('world_set_occluding')(pointerOf('World', this), numbers!, at!, count));
    });
  }
  /** Gives an object its triangles, nine numbers each, in metres about `origin`: all that it shows. Culls with automatic
   * occlusion whose view has the same origin ask for them where the box may be seen; for those of `front` from that side
   * alone: where no view, a shadow map's included, draws their backs. Call it again when the object has moved, behind
   * `move`, or has turned: while its box is another one, they are not asked. None takes them away. */
  setTriangles(handle: Handle, corners: Input<Float32Array>, origin: ArrayLike<number> = [0, 0, 0], sides: Sides = 'both'): void {
    calling((call) => {
      expectObject(this, 'setTriangles', handle);
      const [x, y, z] = readOrigin('setTriangles', origin);
      const count = countOf('setTriangles', 'corners', corners, Float32Array, 3), [at] = call.place([corners, 3 * count]);
      check(need('world_set_triangles')(pointerOf('World', this), handle, at!, count, x!, y!, z!, sidesNumber('setTriangles', sides)));
    });
  }
}

function named(what: string, occluder: OccluderId): OccluderId {
  if (Number.isInteger(occluder) && occluder >= 0 && occluder <= noOccluder) return occluder;
  return refuse(`${what}: an occluder named ${said(occluder)}, expected what addOccluder returned`);
}

function placeOrigins(origins: Input<Float64Array> | readonly [number, number, number], count: number): Input<Float64Array> {
  if (ArrayBuffer.isView(origins) || Block.is(origins)) {
    expectColumn('setOccluders: origins', origins as Input<Float64Array>, Float64Array, 3 * count);
    return origins as Input<Float64Array>;
  }
  const origin = readOrigin('setOccluders', origins);
  return Float64Array.from({ length: 3 * count }, (_, i) => origin[i % 3]!);
}
