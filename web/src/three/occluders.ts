// Which things occlude, frame by frame: those that look largest. Whatever picks better takes this file's place.
import { Frustum, Matrix4 } from 'three';
import type { BufferGeometry, Camera, InstancedMesh, Material, Mesh, Object3D } from 'three';
import { said } from '../errors.js';
import type { OcclusionBuffer } from '../occlusion.js';
import { beginFrame, convexOf, convexOfInstance, type Convex } from './convex.js';
import type { Range } from './instances.js';
import type { Inventory } from './inventory.js';
import type { Batch } from './batches.js';
import { orderOf } from './order.js';
import { isPatched, writesDepth } from './shaders.js';
import { isCalledWhenDrawn, type Thing } from './things.js';

/** Occluders a frame. */
const most = 96;
/** Of the image's height: what covers less does not occlude. */
const least = 0.03;
/** Pixels of the buffer by which occluders are drawn smaller: no GPU is off by as much at the edges of what it draws. */
const margin = 0.7;

// Draws every pixel that its triangles cover, with their depth, unless a shader of one's own does something else.
function isWhole(material: Material): boolean {
  const m = material as Material & { wireframe?: boolean; alphaMap?: unknown; transmission?: number };
  return m.visible && !m.transparent && m.alphaTest === 0 && !m.alphaHash && m.depthWrite && m.depthTest && m.colorWrite &&
    m.depthFunc === 3 && m.side !== 1 && !m.wireframe && !m.alphaMap && !m.transmission &&
    !m.polygonOffset && !m.alphaToCoverage && m.blending <= 1 && !m.clippingPlanes?.length && !m.stencilWrite;
}

// The same, and surely. What a shader of one's own does is not known; a mark says it: userData.occluder = true, or another
// geometry that lies inside.
function isSolid(material: Material): boolean {
  const m = material as Material & { displacementMap?: unknown; isShaderMaterial?: boolean; isNodeMaterial?: boolean };
  return isWhole(m) && !m.displacementMap && !m.isShaderMaterial && !m.isNodeMaterial && !isPatched(m);
}

/** With what an object is drawn, if its own materials are visible. */
export const materialsOf = (object: Object3D, override: Material | null): Material[] => {
  const { material } = object as Mesh, own = Array.isArray(material) ? material : [material];
  return own.filter(Boolean).map((m) => (override && (m as { allowOverride?: boolean }).allowOverride !== false ? override : m));
};

// What three draws after all that is opaque.
const isLate = (m: Material): boolean => m.transparent || ((m as { transmission?: number }).transmission ?? 0) > 0;

/** Whether an object, or one below it, writes depth behind what is there, or may empty the depth buffer before others are drawn,
 * so that these may show through occluders. */
export function breaksDepth(object: Object3D, override: Material | null): boolean {
  return object.visible && ((object.renderOrder < 0 && isCalledWhenDrawn(object)) ||
    object.children.some((child) => breaksDepth(child, override)) ||
    materialsOf(object, override).some((m) => m.depthWrite && (!m.depthTest || m.depthFunc === 1 || m.depthFunc > 4)));
}

/** Whether an object, or one below it, may empty the depth buffer before what is transparent is drawn, or some of it. (Of what is
 * opaque and has the same renderOrder, nobody knows which three draws first.) */
export function breaksLateDepth(object: Object3D): boolean {
  return object.visible && (isCalledWhenDrawn(object) || object.children.some(breaksLateDepth));
}

/** Whether what lies behind others cannot be seen: not what is drawn through them, or where it is not; nor what is drawn late on
 * purpose, or transparent where `isLateBroken`, as it is drawn over the others where somebody has emptied the depth buffer first. */
export function canBeHidden(mesh: Mesh, override: Material | null, isLateBroken: boolean): boolean {
  return mesh.renderOrder <= 0 && !isCalledWhenDrawn(mesh) && materialsOf(mesh, override).every((m) =>
    !(isLateBroken && isLate(m)) && m.depthTest && (m.depthFunc === 2 || m.depthFunc === 3 || m.depthFunc === 4) &&
    !m.polygonOffset && !m.stencilWrite && !(m as { displacementMap?: unknown }).displacementMap && !writesDepth(m));
}

const wrong = new WeakSet<Mesh>();

/** What a mesh's userData.occluder says: that it may, must not, or by which geometry; what says none of that forbids, too. */
export function markOf(mesh: Mesh): boolean | BufferGeometry | undefined {
  const mark = (mesh.userData?.occluder ?? undefined) as boolean | BufferGeometry | undefined;
  if (mark === undefined || typeof mark === 'boolean' || (mark.isBufferGeometry && mark.attributes.position)) return mark;
  if (!wrong.has(mesh)) console.warn(`Sightline lets ${mesh.type} "${mesh.name}" hide nothing: its userData.occluder is ` +
    `${mark.isBufferGeometry ? 'a geometry without positions' : said(mark)}, expected true, false or a closed convex BufferGeometry`);
  return wrong.add(mesh), false;
}

// Whether three, which draws of a mesh with several materials its groups alone, draws all of it, in the order in which it stands.
function drawsAll({ geometry: { groups, index, attributes } }: Mesh, materials: readonly Material[]): boolean {
  let end = 0;
  for (const { start, count, materialIndex = 0 } of groups)
    if (start <= end && materials[materialIndex]?.visible) end = Math.max(end, start + count);
  return end >= (index ?? attributes.position!).count;
}

/** Whether a mesh hides what lies behind it, where it is drawn as its geometry stands. */
export function mayOcclude(mesh: Mesh, override: Material | null, camera: Camera): boolean {
  const mark = markOf(mesh), { material } = mesh;
  if (mark === false || !mesh.visible || !mesh.layers.test(camera.layers) || isCalledWhenDrawn(mesh)) return false;
  // (What is called when it is drawn may move it.) Of several materials nobody says that they are all there are faces for.
  if (Array.isArray(material) ? !mark || !drawsAll(mesh, material) : !material?.visible) return false;
  const materials = materialsOf(mesh, override);
  if (Array.isArray(material) && materials.length < material.length) return false; // three draws holes there
  return materials.every(mark ? isWhole : isSolid);
}

const frustum = new Frustum(), toClip = new Matrix4();

// As three culls: by spheres, which may be older than the points or given, so that it does not draw all that is in view.
export function setFrustum(camera: Camera): void {
  const { coordinateSystem, reversedDepth } = camera as Camera & { reversedDepth?: boolean };
  toClip.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  frustum.setFromProjectionMatrix(toClip, coordinateSystem, reversedDepth);
}

/** Whether three draws a mesh for the camera of the last setFrustum(). */
export const isInFrustum = (mesh: Mesh): boolean => !mesh.frustumCulled || frustum.intersectsObject(mesh);

/** The shape that a thing which may occludes with; null where it has none. */
function shapeOf({ mesh, kind }: Thing, instance: number): Convex | null {
  const mark = markOf(mesh);
  if (typeof mark === 'object') return convexOf(mark);
  return kind === 'batched' ? convexOfInstance(mesh as Batch, instance) : convexOf(mesh.geometry);
}

const scratch = new Float64Array(16), transform = new Float64Array(16);
transform[15] = 1;

// The matrix of a slot, in the world.
function matrixOf(thing: Thing, instance: number): ArrayLike<number> {
  const world = thing.mesh.matrixWorld.elements;
  if (thing.kind === 'mesh') return world;
  const own = thing.kind === 'instanced'
    ? (thing.mesh as InstancedMesh).instanceMatrix.array
    : (thing.mesh as unknown as Batch)._matricesTexture.image.data;
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += world[4 * k + row]! * own[16 * instance + 4 * column + k]!;
      scratch[4 * column + row] = sum;
    }
  }
  return scratch;
}

/** A view as its occluders see it. */
export interface Eye {
  /** Rigid, about `origin`. */
  worldToEye: ArrayLike<number>;
  eyeToClip: ArrayLike<number>;
  origin: ArrayLike<number>;
  width: number;
  height: number;
  near: number;
}

/** Whether the near plane stands askew, as mirrors have it: it opens occluders wherever it likes. */
export const isSkewed = ({ eyeToClip }: Eye): boolean => eyeToClip[2] !== 0 || eyeToClip[6] !== 0;

// What looks large, ascending; arrays that are kept, as they are filled in every frame.
const found = { slots: new Uint32Array(0), sizes: new Float64Array(0), order: new Uint32Array(0), count: 0 };

/** Draws this frame's occluders among the slots in view, ascending; returns how many. */
export function drawOccluders(buffer: OcclusionBuffer, inventory: Inventory, eye: Eye, camera: Camera,
  override: Material | null, slots: Uint32Array): number {
  if (isSkewed(eye)) return 0;
  const flat = eye.eyeToClip[15] === 1;
  if (found.slots.length < slots.length) {
    const room = 2 * slots.length;
    found.slots = new Uint32Array(room), (found.sizes = new Float64Array(room)), (found.order = new Uint32Array(room));
  }
  found.count = 0, setFrustum(camera), beginFrame();
  inventory.forEachShown(slots, (_, from, to) => findLarge(inventory.boxes.array, eye, { slots, from, to }));
  orderOf(found.sizes, found.count, true, found.order);
  let drawn = 0, tried = 0;
  for (let i = 0; i < found.count; ++i) {
    const slot = found.slots[found.order[i]!]!;
    const thing = inventory.thingOf[slot]!;
    const shape = mayOcclude(thing.mesh, override, camera) ? shapeOf(thing, slot - thing.first) : null;
    if (!shape || !isInFrustum(thing.mesh)) continue;
    if (draw(buffer, inventory, eye, slot, flat, shape)) ++drawn;
    if (++tried === most) break;
  }
  return drawn;
}

// Adds slots that look large, and how large, in halves of the image's height.
function findLarge(boxes: Float64Array, eye: Eye, { slots, from, to }: Range): void {
  const m = eye.worldToEye, flat = eye.eyeToClip[15] === 1, scale = Math.abs(eye.eyeToClip[5]!) / 2;
  const [x, y, z] = [-m[2]!, -m[6]!, -m[10]!], [ox, oy, oz] = [eye.origin[0]!, eye.origin[1]!, eye.origin[2]!];
  const [nx, ny, nz] = [x > 0 ? 0 : 3, y > 0 ? 1 : 4, z > 0 ? 2 : 5], near = eye.near + 1e-3 * Math.abs(eye.near);
  for (let k = from; k < to; ++k) {
    const slot = slots[k]!, at = 6 * slot;
    const nearest = x * (boxes[at + nx]! - ox) + y * (boxes[at + ny]! - oy) + z * (boxes[at + nz]! - oz) - m[14]!;
    // One that is cut by the near plane is open to the eye.
    if (!(nearest > near)) continue;
    const dx = boxes[at + 3]! - boxes[at]!, dy = boxes[at + 4]! - boxes[at + 1]!, dz = boxes[at + 5]! - boxes[at + 2]!;
    const size = (Math.sqrt(dx * dx + dy * dy + dz * dz) * scale) / (flat ? 1 : nearest);
    if (size > least) (found.slots[found.count] = slot), (found.sizes[found.count++] = size);
  }
}

function draw(buffer: OcclusionBuffer, inventory: Inventory, eye: Eye, slot: number, flat: boolean, shape: Convex): boolean {
  const thing = inventory.thingOf[slot]!;
  const matrix = matrixOf(thing, slot - thing.first);
  // three turns a mirrored object's faces round, but not a mirrored instance's.
  if (thing.kind !== 'mesh' && determinantOf(matrix) * determinantOf(thing.mesh.matrixWorld.elements) <= 0) return false;
  const m = eye.worldToEye, boxes = inventory.boxes.array;
  let farthest = -m[14]!;
  for (let axis = 0; axis < 3; ++axis) {
    const row = -m[4 * axis + 2]!;
    farthest += row * (boxes[6 * slot + axis + (row > 0 ? 3 : 0)]! - eye.origin[axis]!);
  }
  // So wide is the margin at the farthest depth.
  const reach = 2 * margin / Math.min(eye.width * Math.abs(eye.eyeToClip[0]!), eye.height * Math.abs(eye.eyeToClip[5]!)) *
    (flat ? 1 : farthest);
  // How far the nearest face is from the centre in the world: no less than by the matrix's smallest stretch.
  const stretch = smallestStretch(matrix);
  const keep = 1 - (1.01 * reach) / (shape.radius * stretch);
  if (!(keep > 0)) return false;
  for (let row = 0; row < 3; ++row) {
    let centre = 0;
    for (let column = 0; column < 3; ++column) {
      transform[4 * column + row] = keep * matrix[4 * column + row]!;
      centre += matrix[4 * column + row]! * shape.centre[column]!;
    }
    transform[12 + row] = matrix[12 + row]! + (1 - keep) * centre - eye.origin[row]!;
  }
  buffer.drawMesh(shape.mesh, transform);
  return true;
}

export function determinantOf(m: ArrayLike<number>): number {
  return m[0]! * (m[5]! * m[10]! - m[9]! * m[6]!) - m[4]! * (m[1]! * m[10]! - m[9]! * m[2]!) +
    m[8]! * (m[1]! * m[6]! - m[5]! * m[2]!);
}

// A lower bound of what the matrix makes of a unit vector.
function smallestStretch(m: ArrayLike<number>): number {
  const determinant = Math.abs(determinantOf(m));
  const a = squareOf(m, 0), b = squareOf(m, 4), c = squareOf(m, 8), product = Math.sqrt(a) * Math.sqrt(b) * Math.sqrt(c);
  if (Math.abs(determinant - product) <= 1e-6 * determinant) return 0.999 * Math.sqrt(Math.min(a, b, c));
  return a + b + c > 0 ? determinant / (a + b + c) : 0;
}
const squareOf = (m: ArrayLike<number>, at: number): number =>
  m[at]! * m[at]! + m[at + 1]! * m[at + 1]! + m[at + 2]! * m[at + 2]!;
