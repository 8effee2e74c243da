// How instances that nobody sees are left out: of an InstancedMesh by drawing a shorter copy of its matrices, of a
// BatchedMesh by listing those that are seen. What the user set stays as it is.
import { InstancedBufferAttribute, Matrix4, Sphere, Vector3 } from 'three';
import type { BufferGeometry, Camera, InstancedMesh, Material } from 'three';
import type { Batch, Thing } from './things.js';

/** A thing's slots in a pass: ascending, from … to - 1 of `slots`. */
export interface Range { slots: Uint32Array; from: number; to: number }

interface Copy { matrix: InstancedBufferAttribute; color: InstancedBufferAttribute | null; list: Uint32Array; versions: string }
const copies = new WeakMap<InstancedMesh, Copy>();

function copyOf(mesh: InstancedMesh, count: number): Copy {
  let copy = copies.get(mesh);
  const room = mesh.instanceColor ? mesh.instanceColor.itemSize : 0;
  if (!copy || copy.matrix.count < count || (copy.color?.itemSize ?? 0) !== room) {
    const size = Math.min(2 * count, mesh.instanceMatrix.count);
    const make = (items: number) => new InstancedBufferAttribute(new Float32Array(size * items), items);
    copy = { matrix: make(16), color: room ? make(room) : null, list: new Uint32Array(0), versions: '' };
    copies.set(mesh, copy);
  }
  return copy;
}

function pick(from: { array: ArrayLike<number>; itemSize: number }, to: InstancedBufferAttribute, list: Uint32Array): void {
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

/** Draws only the listed instances, of which the camera sees the first `seen`, until what it returns is called. */
export function narrow(mesh: InstancedMesh, list: Uint32Array, seen: number): () => void {
  const { instanceMatrix, instanceColor, count } = mesh;
  const copy = copyOf(mesh, list.length);
  const versions = `${instanceMatrix.version} ${instanceColor?.version} ${(instanceColor as { id?: number } | null)?.id}`;
  if (copy.versions !== versions || !isSame(copy.list, list)) {
    pick(instanceMatrix, copy.matrix, list);
    if (instanceColor) pick(instanceColor, copy.color!, list);
    copy.versions = versions, (copy.list = list);
  }
  const own = Object.getOwnPropertyDescriptor(mesh, 'onBeforeShadow');
  const ownAfter = Object.getOwnPropertyDescriptor(mesh, 'onAfterShadow');
  const { onBeforeShadow, onAfterShadow } = mesh;
  if (list.length > seen) {
    mesh.onBeforeShadow = (...all) => ((mesh.count = list.length), onBeforeShadow.apply(mesh, all));
    mesh.onAfterShadow = (...all) => ((mesh.count = seen), onAfterShadow.apply(mesh, all));
  }
  mesh.instanceMatrix = copy.matrix;
  mesh.instanceColor = copy.color;
  mesh.count = seen;
  return () => {
    mesh.instanceMatrix = instanceMatrix, (mesh.instanceColor = instanceColor), (mesh.count = count);
    restore(mesh, 'onBeforeShadow', own), restore(mesh, 'onAfterShadow', ownAfter);
  };
}

/** Gives an object its own property back, or none. */
export function restore(object: object, name: string, own: PropertyDescriptor | undefined): void {
  if (own) Object.defineProperty(object, name, own);
  else delete (object as Record<string, unknown>)[name];
}

const matrix = new Matrix4(), sphere = new Sphere(), eye = new Vector3(), forward = new Vector3();
interface Item { start: number; count: number; z: number; index: number }

/** Lists what of a batch a pass sees, as three lists what its frustum holds: in the same order. */
export function fill(thing: Thing, range: Range | undefined, camera: Camera, geometry: BufferGeometry,
  material: Material): void {
  const batch = thing.mesh as unknown as Batch;
  const bytes = geometry.index ? (geometry.index.array as Uint16Array).BYTES_PER_ELEMENT : 1;
  const items: Item[] = [];
  if (batch.sortObjects) {
    matrix.copy(batch.matrixWorld).invert();
    eye.setFromMatrixPosition(camera.matrixWorld).applyMatrix4(matrix);
    forward.set(0, 0, -1).transformDirection(camera.matrixWorld).transformDirection(matrix);
  }
  for (let k = range?.from ?? 0; k < (range?.to ?? 0); ++k) {
    const index = range!.slots[k]! - thing.first, info = batch._instanceInfo[index];
    if (!info?.visible || !info.active) continue;
    const { start, count } = batch._geometryInfo[info.geometryIndex]!;
    let z = 0;
    if (batch.sortObjects) {
      batch.getMatrixAt(index, matrix);
      batch.getBoundingSphereAt(info.geometryIndex, sphere)!.applyMatrix4(matrix);
      z = sphere.center.sub(eye).dot(forward);
    }
    items.push({ start, count, z, index });
  }
  if (batch.sortObjects) {
    const { customSort } = batch as unknown as { customSort: ((list: Item[], camera: Camera) => void) | null };
    if (customSort) customSort.call(batch, items, camera);
    else items.sort(material.transparent ? (a, b) => b.z - a.z : (a, b) => a.z - b.z);
  }
  items.forEach(({ start, count, index }, i) => {
    batch._multiDrawStarts[i] = start * bytes;
    batch._multiDrawCounts[i] = count;
    batch._indirectTexture.image.data[i] = index;
  });
  batch._indirectTexture.needsUpdate = true;
  batch._multiDrawCount = items.length;
  batch._visibilityChanged = true; // so that three lists anew, should this be taken away
}
