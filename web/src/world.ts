// Boxes that come, move and go, and their cull.
import { placeBoxes, readBoxes, type Boxes } from './boxes.js';
import { refuse, said } from './errors.js';
import {
  bytes, calling, countOf, doubles, expectBlock, expectColumn, expectKind, expectLength, fields, integers, isA, lengthOf, reading, readOptions, type Block,
  type Call, type Input, type Sized } from './memory.js';
import { buffer, check, Owned, pointerOf, wasm } from './runtime.js';
import { cullViewBytes, readView, writeView, type ReadView, type View } from './views.js';

/** Names an object for as long as it stands in its world: 31 bits of id and 22 of generation in one number. Good in that world
 * alone: in another it may name another object, and is taken for that. */
export type Handle = number;
/** The id of a handle: what cull() writes. */
export const idOf = (handle: Handle): number =>
  Number.isSafeInteger(handle) && handle >= 0 ? handle % 2 ** 31 : refuse(`idOf: ${said(handle)}, expected a handle`);
/** In all layers. */
export const allLayers = 0xffffffff;

/** What objects are given besides their boxes, an element an object. */
export interface Columns {
  /** A bit a layer; none: all layers. A view sees what shares a bit with its own. */
  layers?: Input<Uint32Array>;
  /** Numbers of your own that cull() can write instead of ids. */
  values?: Input<Uint32Array>;
}
/** Handles for a call: of many objects, or of one. */
export type Handles = Input<Float64Array> | Handle;

/** @internal Of one handle, too. */
export const handleList = (handles: Handles): Input<Float64Array> => {
  const all = typeof handles === 'number' ? Float64Array.of(handles) : handles;
  expectKind('handles', all, Float64Array);
  return all;
};

/** A world of boxes, anywhere within 10¹¹ m of 0. A refused call changes nothing. */
export class World extends Owned {
  constructor() {
    super('World', 'world_create', 'world_destroy');
  }

  /** Puts objects in. Returns their handles. Linear: some 0.5 µs an object. */
  insert(boxes: Boxes, columns?: Columns): Float64Array {
    return calling((call) => {
      const { data, count, args } = readBoxes('insert', boxes), names = ['layers', 'values'] as const;
      const given = readOptions('insert', columns, [...names]);
      given.forEach((column, i) => column !== undefined && expectColumn(`insert: ${names[i]}`, column, Uint32Array, count));
      const [at, layers, values] = call.place(data, ...given.map((column): Sized => [column, count]));
      const out = call.room(8 * count);
      check(wasm().world_insert!(pointerOf('World', this), ...args(at!), layers!, values!, out));
      return new Float64Array(buffer(), out, count).slice();
    });
  }
  /** Gives each object a new box; one that is listed twice keeps the last. Call it once a frame, with all that moved, or with
   * nothing: what has come to rest is filed again a part a frame. Listing objects in the same order each frame is fastest. */
  move(handles: Handles, boxes: Boxes): void {
    calling((call) => {
      const { data, count, args } = readBoxes('move', boxes);
      const named = handleList(handles);
      expectLength('move: handles', named, count);
      const [at, numbers] = call.place(data, [named, count]);
      check(wasm().world_move!(pointerOf('World', this), numbers!, ...args(at!)));
    });
  }
  /** Takes objects out; their handles are stale from then on. */
  remove(handles: Handles): void {
    calling((call) => {
      const named = handleList(handles), count = lengthOf(named);
      const [numbers] = call.place([named, count]);
      check(wasm().world_remove!(pointerOf('World', this), numbers!, count));
    });
  }
  /** Gives each object new layers. */
  setLayers(handles: Handles, layers: Input<Uint32Array>): void {
    setColumn(this, 'world_set_layers', 'setLayers', handles, layers);
  }
  /** Gives each object a new value. */
  setValues(handles: Handles, values: Input<Uint32Array>): void {
    setColumn(this, 'world_set_values', 'setValues', handles, values);
  }

  /** Objects. */
  get size(): number {
    return wasm().world_size!(pointerOf('World', this));
  }
  /** All ids lie below this: the length of an array by id. */
  get idLimit(): number {
    return wasm().world_id_limit!(pointerOf('World', this));
  }
  /** Whether the handle names an object of this world. */
  contains(handle: Handle): boolean {
    const world = pointerOf('World', this);
    return typeof handle === 'number' && wasm().world_contains!(world, handle) !== 0;
  }
  /** The handle of the object that has this id now. */
  handle(id: number): Handle | undefined {
    const world = pointerOf('World', this);
    // The module would take other numbers modulo 2^32.
    const handle = typeof id === 'number' && id >>> 0 === id ? wasm().world_handle!(world, id) : -1;
    return handle < 0 ? undefined : handle;
  }
  /** The box as it is kept, minimum and maximum: it holds what was given. */
  box(handle: Handle): Float64Array {
    expectObject(this, 'box', handle);
    return calling((call) => {
      const out = call.room(48);
      wasm().world_box!(pointerOf('World', this), handle, out);
      return new Float64Array(buffer(), out, 6).slice();
    });
  }
  /** The object's layers. */
  layers(handle: Handle): number {
    expectObject(this, 'layers', handle);
    return wasm().world_layers!(pointerOf('World', this), handle) >>> 0;
  }
  /** The object's value. */
  value(handle: Handle): number {
    expectObject(this, 'value', handle);
    return wasm().world_value!(pointerOf('World', this), handle) >>> 0;
  }
}

/** @internal Throws unless it names an object. */
export function expectObject(world: World, what: string, handle: Handle): void {
  if (!World.prototype.contains.call(world, handle)) refuse(`${what}: no object has this handle`, 'stale_handle');
}

function setColumn(world: World, name: string, what: string, handles: Handles, column: Input<Uint32Array>): void {
  calling((call) => {
    const named = handleList(handles), count = lengthOf(named);
    expectColumn(what, column, Uint32Array, count);
    const [numbers, at] = call.place([named, count], [column, count]);
    check(wasm()[name]!(pointerOf('World', world), numbers!, at!, count));
  });
}

/** A camera, an eye, a shadow cascade: whatever sees the world. */
export interface CullView extends View {
  /** Sees objects whose layers share a bit with these; none: all. */
  layers?: number;
  /** Pixels of area: drops what covers less, approximately; none: nothing. */
  minArea?: number;
  /** Begun with this same view, occluders drawn. */
  occlusion?: { readonly pointer: number };
}

/** What counted work costs, in any one unit; the library's defaults are nanoseconds. Automatic occlusion weighs by them what it
 * does against what it saves. */
export interface CullCosts {
  /** An object that is left, for who draws it; 0: what reportFrameTime() taught, or 1000. */
  object?: number;
  /** A region, group or chunk looked at; an object tested against planes; one looked at for what it carries. */
  node?: number;
  test?: number;
  candidate?: number;
  /** 8 x 8 pixels emptied or drawn; a box or a sphere drawn; a triangle drawn. */
  tile?: number;
  shape?: number;
  triangle?: number;
  /** A box asked; a triangle asked. */
  query?: number;
  occludee?: number;
}
const defaultCosts: Required<CullCosts> = { // as <sightline/world.hpp> has them, in its order
  object: 0, node: 10, test: 1, candidate: 8, tile: 2, shape: 30, triangle: 15, query: 12, occludee: 10 };
const costBytes = 36;

/** How a call culls. */
export interface CullOptions {
  /** Writes the objects' values instead of their ids. */
  valuesForIds?: boolean;
  /** `automatic`: draws the occluders that the world's objects carry, as far as that pays, and drops what lies behind them;
   * no view brings a buffer. */
  occlusion?: 'none' | 'automatic';
  /** Read by automatic occlusion. */
  costs?: CullCosts;
}

/** What a cull wrote. The arrays lie in the module's memory, until this culler's next call; copy what has to last. */
export interface Culled {
  /** Ids, or values, of what at least one view may see. */
  readonly ids: Uint32Array;
  /** Bit v: view v may see the object. */
  readonly masks: Uint8Array;
  /** Objects tested one by one, nodes visited, and objects that occlusion dropped, summed over the views: of a chunk that is
   * hidden whole all that layers leave, those that planes or `minArea` would drop, too. */
  readonly tested: number;
  readonly nodesVisited: number;
  readonly culledOcclusion: number;
  /** With automatic occlusion, in the unit of the costs: the work of this cull and of drawing what it left; and that of a
   * cull by frustum alone and of drawing all that it leaves. */
  readonly cost: number;
  readonly frustumCost: number;
}

/** Culls worlds, and remembers from frame to frame what helps the next. */
export class Culler extends Owned {
  #ids: Block<Uint32Array> | undefined;
  #masks: Block<Uint8Array> | undefined;
  readonly #views = bytes(8 * cullViewBytes);
  readonly #costs = bytes(costBytes);
  readonly #result = doubles(6);

  constructor() {
    super('Culler', 'culler_create', 'culler_destroy');
  }

  /** What at least one of 1 to 8 views may see, and which views see it, in an order that depends on the calls so
   * far alone, culls between moves among them. Nothing that is visible anywhere on the image is left out, but by `layers` and
   * `minArea`; by a buffer for `centres`, nothing that is visible at a pixel's centre. */
  cull(world: World, views: CullView | readonly CullView[], options?: CullOptions): Culled {
    void pointerOf('Culler', this); // a Proxy of it could call nothing that is private
    const count = this.#run(world, viewList(views), options);
    const [, tested, nodesVisited, culledOcclusion, cost, frustumCost] = this.#result.array;
    return {
      ids: this.#ids!.array.subarray(0, count),
      masks: this.#masks!.array.subarray(0, count),
      tested: tested!, nodesVisited: nodesVisited!, culledOcclusion: culledOcclusion!,
      cost: cost!, frustumCost: frustumCost!,
    };
  }
  /** @internal The same with values for ids, each below `limit` and no other object's, in ascending order. */
  cullSorted(world: World, views: readonly CullView[], limit: number): { count: number; ids: number; masks: number } {
    const count = this.#run(world, views, { valuesForIds: true });
    wasm().sort_ids!(this.pointer, this.#ids!.pointer, this.#masks!.pointer, count, limit);
    return { count, ids: this.#ids!.pointer, masks: this.#masks!.pointer };
  }

  /** Teaches what an object costs, where `costs.object` is 0: how many nanoseconds the frame took to draw what the last cull left,
   * without any wait for the display. It is learned once frames differ in how many they draw. */
  reportFrameTime(nanoseconds: number): void {
    if (typeof nanoseconds !== 'number') refuse(`reportFrameTime: ${said(nanoseconds)}, expected a number`);
    check(wasm().report_frame_time!(pointerOf('Culler', this), nanoseconds));
  }

  override dispose(): void {
    if (Owned.at(this, 'Culler') === 0) return;
    for (const block of [this.#ids, this.#masks, this.#views, this.#costs, this.#result]) block?.dispose();
    super.dispose();
  }

  #run(world: World, views: readonly CullView[], options?: CullOptions): number {
    if (!isA(world, World)) refuse('cull: expected a World');
    const read = views.map(readCullView);
    const [valuesForIds = false, occlusion, costs] = readOptions('cull', options, ['valuesForIds', 'occlusion', 'costs']);
    if (typeof valuesForIds !== 'boolean') refuse(`cull: valuesForIds of ${said(valuesForIds)}, expected true or false`);
    const numbers = readCosts(occlusion, costs), { pointer } = this;
    const capacity = wasm().cull_capacity!(pointerOf('World', world));
    if (!this.#ids || this.#ids.length < capacity) {
      this.#ids?.dispose(), this.#masks?.dispose();
      this.#ids = integers(capacity + (capacity >> 2));
      this.#masks = bytes(this.#ids.length);
    }
    read.forEach((view, v) => writeCullView(view, this.#views.pointer + v * cullViewBytes));
    if (numbers) new Float32Array(buffer(), this.#costs.pointer, costBytes / 4).set(numbers);
    check(wasm().cull!(pointer, pointerOf('World', world), this.#views.pointer, views.length, valuesForIds ? 1 : 0,
      numbers ? this.#costs.pointer : 0, this.#ids.pointer, this.#masks!.pointer, this.#ids.length, this.#result.pointer));
    return this.#result.array[0]!;
  }
}

// Asked how many there are before they are walked.
const viewList = (views: CullView | readonly CullView[]): CullView[] => reading('cull', () => {
  if (!Array.isArray(views)) return [views as CullView];
  const { length } = views;
  if (!Number.isInteger(length) || length < 1 || length > 8) refuse(`cull: ${said(length)} views, expected 1 to 8`);
  return Array.from({ length }, (_, v) => views[v] as CullView);
});

// Undefined where occlusion is not automatic.
function readCosts(occlusion: CullOptions['occlusion'] = 'none', costs?: CullCosts): number[] | undefined {
  if (occlusion === 'none' && costs === undefined) return undefined;
  if (occlusion !== 'none' && occlusion !== 'automatic') refuse(`cull: an occlusion of ${said(occlusion)}, expected none or automatic`);
  const names = Object.keys(defaultCosts) as (keyof CullCosts)[], given = readOptions('cull: costs', costs, names);
  const all = names.map((name, i) => {
    const cost = given[i] ?? defaultCosts[name];
    return typeof cost === 'number' ? cost : refuse(`cull: a cost of ${said(cost)} for ${name}, expected a number`);
  });
  return occlusion === 'automatic' ? all : undefined;
}

interface ReadCullView { view: ReadView; layers: number; minArea: number; occlusion: CullView['occlusion'] }

function readCullView(given: CullView): ReadCullView {
  const view = readView('cull', given);
  const [occlusion, layers = allLayers, area] = fields('cull', given, ['occlusion', 'layers', 'minArea']), minArea = area ?? 0;
  if (occlusion && !(isA(occlusion, Owned) && occlusion.what === 'OcclusionBuffer'))
    refuse('cull: expected an OcclusionBuffer as a view\'s occlusion');
  if (!Number.isInteger(layers) || Math.abs(layers) >= 2 ** 32)
    refuse(`cull: layers of ${said(layers)}, expected an integer of 32 bits`);
  if (typeof minArea !== 'number') refuse(`cull: a minArea of ${said(minArea)}, expected a number`);
  return { view, layers, minArea, occlusion };
}

function writeCullView({ view, layers, minArea, occlusion }: ReadCullView, at: number): void {
  writeView(view, at);
  const data = new DataView(buffer(), at, cullViewBytes);
  data.setUint32(160, occlusion ? occlusion.pointer : 0, true);
  data.setUint32(164, layers, true);
  data.setFloat32(168, minArea, true);
  data.setFloat32(172, 1, true), data.setUint32(176, allLayers, true);  // distances, which objects have none of here
  data.setUint32(180, 0, true);  // casters: none
}

/** The indices of the boxes that a view overlaps, ascending, into `out`, which has room for 64 more than there are boxes;
 * returns how many. Linear: columns of single precision cost least. */
export function cullBoxes(view: View, boxes: Boxes, out: Block<Uint32Array>): number {
  return flat('flat_boxes', view, out, (call) => placeBoxes('cullBoxes', call, boxes).args);
}

/** The same for spheres about the view's origin: four columns, centre x, y, z and radius. */
export function cullSpheres(view: View, spheres: Input<Float32Array>, out: Block<Uint32Array>): number {
  return flat('flat_spheres', view, out, (call) => {
    const count = countOf('cullSpheres', 'spheres', spheres, Float32Array, 4), [at] = call.place([spheres, 4 * count]);
    return [at!, count];
  });
}

function flat(name: string, view: View, out: Block<Uint32Array>, place: (call: Call) => number[]): number {
  expectBlock('cull: out', out, Uint32Array);
  return calling((call) => {
    // Room comes last: it may have the memory grow, which takes away what is not placed yet.
    const read = readView('cull', view), args = place(call), viewAt = call.room(176), result = viewAt + 168;
    writeView(read, viewAt);
    check(wasm()[name]!(viewAt, ...args, out.pointer, out.length, result));
    return new Float64Array(buffer(), result, 1)[0]!;
  });
}
