// What of a scene is culled: meshes, and the instances of instanced and batched ones, each with a range of slots.
import type { BufferGeometry, InstancedMesh, Mesh } from 'three';
import { BatchedMesh, Box3, Object3D } from 'three';
import { isKnownInside, listen, unlisten, type Batch, type Told } from './batches.js';
import { boxOf, isInstancedGeometry, isStill, ownSphereOf, pointsOf, reachOf, SeenSphere, withOwnSphere, type Points } from './bounds.js';
import { isNowhere, putNowhere, widen, writeBox } from './boxes.js';
import { Matrices } from './matrices.js';
import { letGo, Ranges, remind } from './ranges.js';
import { release } from './release.js';
import { Sending } from './sending.js';
import { callsBack, countsInstances } from './shaders.js';
import { Turning } from './turning.js';

export interface Thing {
  readonly mesh: Mesh;
  readonly kind: 'mesh' | 'instanced' | 'batched';
  /** Slots first … first + count - 1. */
  readonly first: number;
  readonly count: number;
  /** Of these so many have something that is drawn; the others, as of a batch that has room for more, are nowhere. And of an
   * InstancedMesh, how many instances it drew. */
  live: number;
  shown: number;
  /** Of the node above it, in Inventory.nodes. */
  readonly parent: number;
  /** What its boxes were made of. */
  geometry: BufferGeometry;
  points: Points;
  pointsVersion: number;
  /** The geometry's, and a mesh's own; of instances, where their mesh's own says that they may be. */
  readonly sphere: SeenSphere;
  readonly ownSphere: SeenSphere;
  reach: Box3 | null;
  given: Box3 | null;
  readonly turning: Turning;
  /** Of its instances: their matrices; of a batch's, where those come from, in which version, and what it was told since. */
  readonly matrices: Matrices | undefined;
  source: unknown;
  version: number;
  readonly told: Told | undefined;
  readonly sending: Sending | undefined;
  /** Of an InstancedMesh: what was set of its matrices, and in how many frames on end much of it moved. */
  readonly ranges: Ranges | undefined;
  restless: number;
}

/** What is known by slot, of instanced ones their mesh's matrix by the first; and the slots whose boxes have changed. */
export interface Known { boxes: Float64Array; matrices: Float64Array; moved: number[] }

// Lines as wide as one likes are meshes of instanced geometries, and displaced points are where no box says.
const isPlain = (mesh: Mesh): boolean =>
  mesh.children.length === 0 && mesh.frustumCulled && mesh.userData?.sightline !== false && isStill(mesh) && !isDisplaced(mesh.material) &&
  ((mesh as { isInstancedMesh?: boolean }).isInstancedMesh || !isInstancedGeometry(mesh));

export const isDisplaced = (material: Mesh['material'] | null | undefined): boolean =>
  Array.isArray(material) ? material.some(isDisplaced) : Boolean((material as { displacementMap?: unknown } | undefined)?.displacementMap);

const own = Object3D.prototype, { onBeforeRender: listing } = BatchedMesh.prototype;
/** Whether it or its material has callbacks of its own or of its class for when it is drawn. */
export const isCalledWhenDrawn = (object: Object3D): boolean => object.onAfterRender !== own.onAfterRender ||
  object.onBeforeRender !== ((object as { isBatchedMesh?: boolean }).isBatchedMesh ? listing : own.onBeforeRender) ||
  callsBack((object as Mesh).material);
/** The same, and for shadows. What they do besides, such as drawing a picture that others show, has to be done as often as without
 * a culler. */
export const isCalled = (mesh: Mesh): boolean => isCalledWhenDrawn(mesh) ||
  mesh.onBeforeShadow !== own.onBeforeShadow || mesh.onAfterShadow !== own.onAfterShadow;

// Instances without attributes of their own, and which no shader counts, nor any material's callback: shorter copies of their
// matrices and colours are all that is made.
function isSimple(mesh: InstancedMesh): boolean {
  if (mesh.morphTexture || mesh.instanceMatrix.count === 0) return false;
  const { material, customDepthMaterial, customDistanceMaterial, userData } = mesh;
  if (userData?.sightline !== true && [material, customDepthMaterial, customDistanceMaterial].flat()
    .some((one) => countsInstances(one) || callsBack(one))) return false;
  return Object.values(mesh.geometry.attributes).every((attribute) => {
    const { isInstancedBufferAttribute, data } = attribute as unknown as {
      isInstancedBufferAttribute?: boolean; data?: { isInstancedInterleavedBuffer?: boolean } };
    return !isInstancedBufferAttribute && !data?.isInstancedInterleavedBuffer;
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
  if (!mesh.isBatchedMesh) return isCalled(mesh) ? undefined : { kind: 'mesh', count: 1 };
  const batch = object as Batch;
  return isKnownInside(batch) && batch.perObjectFrustumCulled ? { kind: 'batched', count: batch.maxInstanceCount } : undefined;
}

/** A thing, of which nothing is known yet. */
export function makeThing(mesh: Mesh, kind: Thing['kind'], first: number, count: number, parent: number): Thing {
  const { geometry } = mesh;
  return { mesh, kind, first, count, parent, geometry, points: pointsOf(geometry), pointsVersion: -1, given: null,
    live: kind === 'mesh' ? 1 : 0, shown: 0, turning: new Turning(),
    sphere: new SeenSphere(), ownSphere: new SeenSphere(), reach: null,
    matrices: kind === 'mesh' ? undefined : new Matrices(count), source: undefined, version: -1,
    told: kind === 'batched' ? listen(mesh as Batch) : undefined,
    sending: kind === 'batched' ? new Sending(count) : undefined,
    ranges: kind === 'instanced' ? new Ranges() : undefined, restless: 0 };
}

/** To be called of each InstancedMesh in every frame, before three draws. */
export function takeNote({ mesh, ranges }: Thing): void {
  const { instanceMatrix, instanceColor } = mesh as InstancedMesh;
  ranges!.note(instanceMatrix), remind(instanceColor);
}

export function disposeOf({ mesh, kind, matrices, told }: Thing): void {
  release(matrices);
  if (told) unlisten(mesh as Batch, told);
  if (kind === 'instanced') letGo((mesh as InstancedMesh).instanceMatrix), letGo((mesh as InstancedMesh).instanceColor);
}

/** Whether a thing is no longer what it was taken for. */
export function isOther(thing: Thing): boolean {
  const { mesh, kind, count } = thing;
  if (!isPlain(mesh)) return true;
  if (kind === 'mesh') return isCalled(mesh);
  if (kind === 'instanced') return (mesh as InstancedMesh).instanceMatrix.count !== count || !isSimple(mesh as InstancedMesh);
  return (mesh as Batch).maxInstanceCount !== count || !(mesh as Batch).perObjectFrustumCulled;
}

/** The sum of a number out of each cache line of the things' matrices, which says nothing: so many reads that wait for nothing
 * but memory wait together, where comparing one matrix after the other waits for each. */
export function sumOf(things: readonly Thing[]): number {
  let sum = 0;
  for (const { mesh: { matrixWorld: { elements } } } of things) sum += elements[0]! + elements[7]! + elements[14]!;
  return sum;
}

/** Brings the boxes of what has moved up to date. */
export function update(thing: Thing, known: Known): void {
  const { mesh, kind } = thing, m = mesh.matrixWorld.elements;
  const isMoved = moves(known.matrices, 12 * thing.first, m), isTurned = thing.turning.changes(mesh);
  if (kind === 'batched') return updateBatch(thing, mesh as Batch, isMoved || isTurned, known);
  const isReshaped = reshapes(thing, mesh) || isTurned;
  if (kind === 'instanced') return updateInstances(thing, mesh as InstancedMesh, isMoved || isReshaped, known);
  if (!isMoved && !isReshaped) return;
  const box = withOwnSphere(thing.turning.around(boxOf(mesh.geometry)), mesh);
  if (writeBox(known.boxes, thing.first, box, m, 0)) known.moved.push(thing.first);
}

// Whether a mesh has other points than are known of it; takes them over.
function reshapes(thing: Thing, mesh: Mesh): boolean {
  const { geometry } = mesh, points = pointsOf(geometry), { version } = points;
  const isOther = thing.sphere.changes(geometry.boundingSphere);
  const isOwnOther = thing.kind === 'mesh' && thing.ownSphere.changes(ownSphereOf(mesh));
  if (geometry === thing.geometry && points === thing.points && version === thing.pointsVersion && !isOther && !isOwnOther &&
    geometry.boundingBox === thing.given) return false;
  thing.geometry = geometry, (thing.points = points), (thing.pointsVersion = version);
  thing.given = geometry.boundingBox;
  return true;
}

/** Whether an affine matrix is another than the twelve numbers that are known of it; takes them over. */
export function moves(known: Float64Array, at: number, m: readonly number[]): boolean {
  if (known[at] === m[0] && known[at + 1] === m[1] && known[at + 2] === m[2] && known[at + 3] === m[4] &&
    known[at + 4] === m[5] && known[at + 5] === m[6] && known[at + 6] === m[8] && known[at + 7] === m[9] &&
    known[at + 8] === m[10] && known[at + 9] === m[12] && known[at + 10] === m[13] && known[at + 11] === m[14]) return false;
  for (let column = 0; column < 4; ++column)
    for (let row = 0; row < 3; ++row) known[at + 3 * column + row] = m[4 * column + row]!;
  return true;
}

// An InstancedMesh much of which moves in so many frames on end costs more to know than to draw.
const mostRestless = 4;
const isMuch = (moved: number, count: number): boolean => moved > 1000 && 4 * moved > count;
export const isRestless = ({ restless }: Thing): boolean => restless >= mostRestless;

// A slot of which nothing is drawn any more, if something was; and one of which something is.
function hide(thing: Thing, i: number, { boxes, moved }: Known): void {
  const slot = thing.first + i;
  if (isNowhere(boxes, slot)) return;
  putNowhere(boxes, slot, slot + 1), moved.push(slot), --thing.live;
}
function show(thing: Thing, i: number, { boxes }: Known): void {
  if (isNowhere(boxes, thing.first + i)) ++thing.live;
}

const reached = new Float64Array(6); // by all instances of a mesh, in the world

function updateInstances(thing: Thing, mesh: InstancedMesh, all: boolean, known: Known): void {
  const { boxes, moved } = known;
  const { matrices, first, count, shown } = thing, ranges = thing.ranges!, now = mesh.instanceMatrix.array as Float32Array;
  const drawn = (thing.shown = Math.min(Math.max(mesh.count, 0), count));
  const reach = reachOf(mesh);
  if (reach !== thing.reach) (thing.reach = reach), (all = true);
  if (!all && ranges.isEmpty && drawn === shown) return;
  const box = thing.turning.around(boxOf(mesh.geometry)), world = mesh.matrixWorld.elements, before = moved.length;
  if (reach) writeBox(reached, 0, reach, world, 0);
  const write = (i: number) => {
    if (i >= drawn) return hide(thing, i, known);
    show(thing, i, known);
    if (!writeBox(boxes, first + i, box, now, 16 * i, world) && !reach) return;
    if (reach) widen(boxes, first + i, reached);
    moved.push(first + i);
  };
  if (all || ranges.isOther) {
    matrices!.takeAll(now);
    for (let i = 0; i < count; ++i) write(i);
  } else if (ranges.isWhole) {
    matrices!.compare(now, 0, count, write);
  } else {
    for (let k = 0; k < ranges.list.length; k += 2) // three itself draws nothing else anew
      matrices!.compare(now, ranges.list[k]! >> 4, Math.min((ranges.list[k + 1]! + 15) >> 4, count), write);
  }
  for (let i = Math.min(drawn, shown); i < Math.max(drawn, shown); ++i) write(i);
  thing.restless = isMuch(moved.length - before, count) ? thing.restless + 1 : 0;
  ranges.forget();
}

function updateBatch(thing: Thing, mesh: Batch, isMoved: boolean, known: Known): void {
  const { boxes, moved } = known;
  const { geometry, _matricesTexture: { version, image: { data } }, _instanceInfo: infos } = mesh;
  const told = thing.told!, sending = thing.sending!;
  const all = isMoved || told.all || data !== thing.source || geometry !== thing.geometry;
  if (!all && told.instances.length === 0 && version === thing.version) return;
  // Somebody has written there by themselves.
  const isWritten = version !== thing.version + told.versions;
  if (isWritten || told.all || data !== thing.source) sending.noteAll(version);
  else for (const i of told.instances) sending.note(i, version);
  const world = mesh.matrixWorld.elements, around = new Map<number, Box3>(); // of geometries whose points may turn
  const boxAround = (geometry: number): Box3 => {
    if (!thing.turning.may) return boxInBatch(mesh, geometry);
    let box = around.get(geometry);
    if (!box) around.set(geometry, (box = thing.turning.around(boxInBatch(mesh, geometry))));
    return box;
  };
  const write = (i: number) => {
    const info = infos[i];
    if (!info?.active) return hide(thing, i, known);
    show(thing, i, known);
    if (writeBox(boxes, thing.first + i, boxAround(info.geometryIndex), data, 16 * i, world)) moved.push(thing.first + i);
  };
  if (all) {
    thing.matrices!.takeAll(data);
    for (let i = 0; i < infos.length; ++i) write(i);
  } else {
    for (const i of told.instances) thing.matrices!.take(data, i), write(i);
    if (isWritten) thing.matrices!.compare(data, 0, infos.length, write);
  }
  thing.source = data, (thing.version = version), (thing.geometry = geometry);
  told.instances.length = told.versions = 0, (told.all = false);
}

const local = new Box3();
function boxInBatch(batch: Batch, geometry: number): Box3 {
  return batch._geometryInfo[geometry]!.boundingBox ?? batch.getBoundingBoxAt(geometry, local)!;
}
