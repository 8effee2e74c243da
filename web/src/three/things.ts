// What of a scene is culled: meshes, and the instances of instanced and batched ones, each with a range of slots.
import type { BatchedMesh, Box3, BufferGeometry, InstancedMesh, Mesh, Object3D } from 'three';
import { Box3 as Box } from 'three';
import { writeBox } from './boxes.js';

/** What three keeps of a batch; without it (it may be named otherwise one day) a batch is drawn as three would. */
export interface BatchInside {
  _instanceInfo: { visible: boolean; active: boolean; geometryIndex: number }[];
  _geometryInfo: { start: number; count: number }[];
  _matricesTexture: { version: number; image: { data: Float32Array } };
  _multiDrawStarts: Int32Array;
  _multiDrawCounts: Int32Array;
  _multiDrawCount: number;
  _indirectTexture: { needsUpdate: boolean; image: { data: Uint32Array } };
  _visibilityChanged: boolean;
}
export type Batch = BatchedMesh & BatchInside;

const batchInside = ['_instanceInfo', '_geometryInfo', '_matricesTexture', '_multiDrawStarts', '_multiDrawCounts',
  '_multiDrawCount', '_indirectTexture', '_visibilityChanged'];

export interface Thing {
  readonly mesh: Mesh;
  readonly kind: 'mesh' | 'instanced' | 'batched';
  /** Slots first … first + count - 1. */
  readonly first: number;
  readonly count: number;
  /** Of the node above it, in Inventory.nodes. */
  readonly parent: number;
  geometry: BufferGeometry;
  readonly matrix: Float64Array;
  version: number;
  /** Of its instances, as their boxes were made. */
  readonly matrices: Float32Array;
  shapes: number;
}

const local = new Box();

const isPlain = (mesh: Mesh): boolean =>
  mesh.children.length === 0 && mesh.frustumCulled && !(mesh as { isSkinnedMesh?: boolean }).isSkinnedMesh &&
  !mesh.morphTargetInfluences?.length && mesh.userData.sightline !== false &&
  mesh.geometry?.attributes.position !== undefined;

// Instances whose other attributes can be picked out one by one.
function isSimple(mesh: InstancedMesh): boolean {
  if (mesh.morphTexture || mesh.instanceMatrix.count === 0) return false;
  return Object.values(mesh.geometry.attributes).every((attribute) => {
    const { isInstancedBufferAttribute, meshPerAttribute, data } = attribute as unknown as {
      isInstancedBufferAttribute?: boolean; meshPerAttribute?: number; data?: { isInstancedInterleavedBuffer?: boolean } };
    return isInstancedBufferAttribute ? meshPerAttribute === 1 : !data?.isInstancedInterleavedBuffer;
  });
}

/** How many slots an object takes, and as what; undefined where three is to draw it by itself, with all below it. */
export function classify(object: Object3D): { kind: Thing['kind']; count: number } | undefined {
  const mesh = object as Mesh & { isInstancedMesh?: boolean; isBatchedMesh?: boolean };
  if (!mesh.isMesh || !isPlain(mesh)) return undefined;
  if (mesh.isInstancedMesh) {
    const instanced = object as InstancedMesh;
    return isSimple(instanced) ? { kind: 'instanced', count: instanced.instanceMatrix.count } : undefined;
  }
  if (!mesh.isBatchedMesh) return { kind: 'mesh', count: 1 };
  const batch = object as Batch;
  if (!batchInside.every((name) => name in batch) || !batch.perObjectFrustumCulled) return undefined;
  return { kind: 'batched', count: batch.maxInstanceCount };
}

/** Whether a thing is no longer what it was taken for. */
export function isOther(thing: Thing): boolean {
  const { mesh, kind, count } = thing;
  if (mesh.children.length > 0 || !mesh.frustumCulled) return true;
  if (kind === 'instanced') return (mesh as InstancedMesh).instanceMatrix.count !== count;
  return kind === 'batched' && ((mesh as Batch).maxInstanceCount !== count || !(mesh as Batch).perObjectFrustumCulled);
}

// Whether instance i has another matrix than its box was made of.
function isMoved(thing: Thing, matrices: ArrayLike<number>, i: number): boolean {
  const known = thing.matrices;
  let moved = false;
  for (let k = 16 * i; k < 16 * i + 15; ++k) {
    if (known[k] !== matrices[k]) (moved = true), (known[k] = matrices[k]!);
  }
  return moved;
}

function boxOf(geometry: BufferGeometry): Box3 {
  if (geometry.boundingBox === null) geometry.computeBoundingBox();
  return geometry.boundingBox!;
}

/** Brings the boxes of what has moved up to date, and tells their slots. */
export function update(thing: Thing, boxes: Float64Array, moved: (slot: number) => void, anew = false): void {
  const { mesh, kind, matrix } = thing;
  const elements = mesh.matrixWorld.elements;
  let changed = anew || mesh.geometry !== thing.geometry || mesh.geometry.boundingBox === null;
  for (let i = 0; i < 15; ++i) if (elements[i] !== matrix[i]) (changed = true), (matrix[i] = elements[i]!);
  thing.geometry = mesh.geometry;
  if (kind === 'mesh') {
    if (changed && writeBox(boxes, thing.first, boxOf(mesh.geometry), elements, 0)) moved(thing.first);
  } else if (kind === 'instanced') {
    updateInstances(thing, mesh as InstancedMesh, changed, boxes, moved);
  } else {
    updateBatch(thing, mesh as Batch, changed, boxes, moved);
  }
}

function updateInstances(thing: Thing, mesh: InstancedMesh, changed: boolean, boxes: Float64Array,
  moved: (slot: number) => void): void {
  const { version, array } = mesh.instanceMatrix;
  if (!changed && version === thing.version) return;
  thing.version = version;
  const box = boxOf(mesh.geometry), world = mesh.matrixWorld.elements;
  for (let i = 0; i < thing.count; ++i) {
    if (!isMoved(thing, array, i) && !changed) continue;
    if (writeBox(boxes, thing.first + i, box, array, 16 * i, world)) moved(thing.first + i);
  }
}

function updateBatch(thing: Thing, mesh: Batch, changed: boolean, boxes: Float64Array,
  moved: (slot: number) => void): void {
  const { _matricesTexture: matrices, _instanceInfo: all } = mesh;
  let shapes = 0; // which geometry each instance has, of which three keeps no version
  for (let i = 0; i < all.length; ++i) shapes = (Math.imul(shapes, 31) + (all[i]!.active ? all[i]!.geometryIndex : -1)) | 0;
  if (shapes !== thing.shapes) (changed = true), (thing.shapes = shapes);
  if (!changed && matrices.version === thing.version) return;
  thing.version = matrices.version;
  const world = mesh.matrixWorld.elements, data = matrices.image.data;
  let known = -1;
  for (let i = 0; i < all.length; ++i) {
    const { active, geometryIndex } = all[i]!;
    if (!active || (!isMoved(thing, data, i) && !changed)) continue;
    if (known !== geometryIndex) mesh.getBoundingBoxAt((known = geometryIndex), local);
    if (writeBox(boxes, thing.first + i, local, data, 16 * i, world)) moved(thing.first + i);
  }
}
