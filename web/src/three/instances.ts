// How instances that nobody sees are left out: of an InstancedMesh by drawing a shorter copy of its matrices, of a
// BatchedMesh by listing those that are seen. What the user set stays as it is.
import { InstancedBufferAttribute, InstancedMesh, Matrix4, Object3D, Sphere, Vector3 } from 'three';
import type { BufferGeometry, Camera, Material } from 'three';
import type { Batch } from './batches.js';
import { orderOf } from './order.js';
import { isUnsent, withhold } from './ranges.js';
import { restore } from './restore.js';
import type { Sender } from './sending.js';
import type { Thing } from './things.js';

/** A thing's slots in a pass: ascending, from … to - 1 of `slots`. */
export interface Range { slots: Uint32Array; from: number; to: number }

type Attribute = InstancedBufferAttribute;
interface Copy {
  matrix: Attribute;
  color: Attribute | null;
  list: Uint32Array;
  /** What it was copied from, and the versions of those. */
  from: (Attribute | number | null | undefined)[];
}
const copies = new WeakMap<InstancedMesh, Copy>();

function copyOf(mesh: InstancedMesh, count: number): Copy {
  let copy = copies.get(mesh);
  const { instanceMatrix, instanceColor } = mesh;
  if (!copy || copy.matrix.count < count || !isAlike(copy.color, instanceColor)) {
    const size = Math.min(2 * count, instanceMatrix.count);
    const color = instanceColor && room(instanceColor, size);
    copy = { matrix: room(instanceMatrix, size), color, list: new Uint32Array(0), from: [] };
    copies.set(mesh, copy);
  }
  return copy;
}

// Another attribute of the same kind: numbers of other kinds mean other colours.
function room({ array, itemSize, normalized, gpuType }: Attribute, size: number): Attribute {
  const Kind = array.constructor as Float32ArrayConstructor;
  const made = new InstancedBufferAttribute(new Kind(size * itemSize), itemSize, normalized);
  made.gpuType = gpuType;
  return made;
}
const isAlike = (a: Attribute | null, b: Attribute | null): boolean => a === b || (a !== null && b !== null &&
  a.array.constructor === b.array.constructor && a.itemSize === b.itemSize && a.normalized === b.normalized);

function pick(from: Attribute, to: Attribute, list: Uint32Array): void {
  const { itemSize } = from, target = to.array;
  for (let k = 0; k < list.length; ++k) {
    const at = list[k]! * itemSize;
    for (let i = 0; i < itemSize; ++i) target[k * itemSize + i] = from.array[at + i]!;
  }
  to.clearUpdateRanges();
  to.addUpdateRange(0, list.length * itemSize);
  to.needsUpdate = true;
}

const isSame = (a: Uint32Array, b: Uint32Array): boolean => a.length === b.length && a.every((x, i) => x === b[i]);

/** What a mesh draws while a culled scene is drawn: fewer instances, or, for a render within that one, all of them again. */
export interface Narrowing { apply(): void; undo(): void }

const callbacks = ['onBeforeRender', 'onAfterRender', 'onBeforeShadow', 'onAfterShadow'] as const;
type Callback = (...all: unknown[]) => void;

/** Draws only the listed instances, of which the camera sees the first `seen`, once it is applied. */
export function narrow(mesh: InstancedMesh, list: Uint32Array, seen: number): Narrowing {
  const { instanceMatrix, instanceColor } = mesh;
  const copy = copyOf(mesh, list.length);
  const from = [instanceMatrix, instanceMatrix.version, instanceColor, instanceColor?.version];
  if (from.some((one, i) => one !== copy.from[i]) || !isSame(copy.list, list)) {
    pick(instanceMatrix, copy.matrix, list);
    if (instanceColor) pick(instanceColor, copy.color!, list);
    copy.from = from, (copy.list = list);
  }
  let own = ownOf(mesh);
  const shorten = (count: number) => {
    // A render within a callback has done so already.
    if (mesh.instanceMatrix !== copy.matrix) own = ownOf(mesh);
    mesh.instanceMatrix = copy.matrix, (mesh.instanceColor = copy.color), (mesh.count = count);
  };
  const undos: (() => void)[] = [];
  const apply = () => {
    withhold(instanceMatrix);
    if (instanceColor) withhold(instanceColor);
    for (const name of callbacks) {
      const isLonger = list.length > seen && name.endsWith('Shadow');
      if (!isLonger && mesh[name] === Object3D.prototype[name]) continue;
      // The user's own callback finds the mesh as the user has made it.
      undos.push(put(mesh, name, (call, all) => {
        Object.assign(mesh, own), call.apply(mesh, all), shorten(name === 'onBeforeShadow' ? list.length : seen);
      }));
    }
    shorten(seen);
  };
  const undo = () => {
    Object.assign(mesh, own);
    for (const takeAway of undos.splice(0)) takeAway();
  };
  return { apply, undo };
}

const ownOf = ({ instanceMatrix, instanceColor, count }: InstancedMesh) => ({ instanceMatrix, instanceColor, count });

// Puts a callback over a mesh's own; returns what takes it away, unless the own one has put another there.
function put(mesh: InstancedMesh, name: (typeof callbacks)[number],
  over: (call: Callback, all: unknown[]) => void): () => void {
  const before = Object.getOwnPropertyDescriptor(mesh, name), call = mesh[name] as Callback;
  const ours = (mesh[name] = (...all: unknown[]) => over(call, all));
  return () => mesh[name] === ours && restore(mesh, name, before);
}

const carriers = new WeakMap<InstancedMesh, InstancedMesh>();

/** What to draw with a mesh that shows a shorter copy, or what was withheld, so that three sends it: an object's instances it sends
 * once a frame, and up to 0.186 it takes what a light looked at in one frame for sent in the next. No light looks at this one, and
 * nothing of it is drawn. */
export function carrierOf(mesh: InstancedMesh): InstancedMesh | undefined {
  const { geometry, instanceMatrix, instanceColor } = mesh;
  if (copies.get(mesh)?.matrix !== instanceMatrix && !isUnsent(instanceMatrix) && !isUnsent(instanceColor)) return undefined;
  let carrier = carriers.get(mesh);
  if (!carrier) {
    carriers.set(mesh, (carrier = new InstancedMesh(geometry, [], 0)));
    carrier.frustumCulled = false, (carrier.boundingSphere = new Sphere()), carrier.layers.enableAll();
  }
  return Object.assign(carrier, { geometry, instanceMatrix, instanceColor });
}

const matrix = new Matrix4(), eye = new Vector3(), forward = new Vector3();
// Of the instances that are being listed; larger than they are many.
let instances = new Uint32Array(0), order = new Uint32Array(0), depths = new Float64Array(0);

/** Lists what of a batch a pass sees, as three lists what its frustum holds: in the same order. */
export function fill(thing: Thing, range: Range | undefined, renderer: Sender, camera: Camera, geometry: BufferGeometry,
  material: Material): void {
  const batch = thing.mesh as Batch;
  let count = collect(batch, thing.first, range);
  const bytes = geometry.index ? (geometry.index.array as Uint16Array).BYTES_PER_ELEMENT : 1;
  if (batch.sortObjects) {
    matrix.copy(batch.matrixWorld).invert();
    eye.setFromMatrixPosition(camera.matrixWorld).applyMatrix4(matrix);
    forward.set(0, 0, -1).transformDirection(camera.matrixWorld).transformDirection(matrix);
    for (let k = 0; k < count; ++k) depths[k] = depthOf(batch, instances[k]!);
    const customSort = batch.customSort as Sort | null;
    if (customSort) count = sortBy(customSort, batch, camera, count);
    else orderOf(depths, count, material.transparent, order);
  } else {
    for (let k = 0; k < count; ++k) order[k] = k;
  }
  list(batch, bytes, count);
  thing.sending!.begin(renderer, batch, thing.version, instances, count);
}

// Those of a range that are shown.
function collect({ _instanceInfo: infos }: Batch, first: number, range: Range | undefined): number {
  if (!range) return 0;
  const { slots, from, to } = range;
  if (instances.length < to - from) {
    instances = new Uint32Array(2 * (to - from)), (order = new Uint32Array(2 * (to - from)));
    depths = new Float64Array(2 * (to - from));
  }
  let count = 0;
  for (let k = from; k < to; ++k) {
    const info = infos[slots[k]! - first];
    if (info?.visible && info.active) instances[count++] = slots[k]! - first;
  }
  return count;
}

interface Item { start: number; count: number; z: number; index: number }
type Sort = (this: Batch, list: Item[], camera: Camera) => void;

// The user's own order, of what three hands to it; how many it leaves.
function sortBy(sort: Sort, batch: Batch, camera: Camera, count: number): number {
  const items = Array.from(instances.subarray(0, count), (index, k): Item => {
    const { start, count: corners } = shapeOf(batch, index);
    return { start, count: corners, z: depths[k]!, index };
  });
  sort.call(batch, items, camera);
  items.forEach(({ index }, k) => ((instances[k] = index), (order[k] = k)));
  return items.length;
}

const shapeOf = (batch: Batch, instance: number) => batch._geometryInfo[batch._instanceInfo[instance]!.geometryIndex]!;

// How far in front of the eye the middle of an instance's sphere is, by the operations that three does it with.
function depthOf(batch: Batch, instance: number): number {
  const { x, y, z } = (shapeOf(batch, instance).boundingSphere ?? sphereOf(batch, instance)).center;
  const e = batch._matricesTexture.image.data, at = 16 * instance;
  const w = 1 / (e[at + 3]! * x + e[at + 7]! * y + e[at + 11]! * z + e[at + 15]!);
  const dx = (e[at]! * x + e[at + 4]! * y + e[at + 8]! * z + e[at + 12]!) * w - eye.x;
  const dy = (e[at + 1]! * x + e[at + 5]! * y + e[at + 9]! * z + e[at + 13]!) * w - eye.y;
  const dz = (e[at + 2]! * x + e[at + 6]! * y + e[at + 10]! * z + e[at + 14]!) * w - eye.z;
  return dx * forward.x + dy * forward.y + dz * forward.z;
}
const sphereOf = (batch: Batch, instance: number) =>
  batch.getBoundingSphereAt(batch._instanceInfo[instance]!.geometryIndex, new Sphere())!;

// Hands the instances to three in their order.
function list(batch: Batch, bytes: number, count: number): void {
  const { _multiDrawStarts: starts, _multiDrawCounts: counts, _indirectTexture: texture } = batch, { data } = texture.image;
  for (let i = 0; i < count; ++i) {
    const instance = instances[order[i]!]!, shape = shapeOf(batch, instance);
    starts[i] = shape.start * bytes, (counts[i] = shape.count), (data[i] = instance);
  }
  texture.needsUpdate = true;
  batch._multiDrawCount = count;
  batch._visibilityChanged = true; // so that three lists anew, should this be taken away
}
