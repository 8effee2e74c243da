// Bounds of geometries, which are made anew where their points have changed.
import { Box3, Sphere, Vector3 } from 'three';
import type { BatchedMesh, BufferAttribute, BufferGeometry, InstancedMesh, Mesh } from 'three';

/** What has a version of a geometry's points. */
export interface Points { version: number }

/** Whether what is drawn of a mesh are its geometry's points as they stand: nothing bends them. */
export const isStill = (mesh: Mesh): boolean => !(mesh as { isSkinnedMesh?: boolean }).isSkinnedMesh &&
  !mesh.morphTargetInfluences?.length && mesh.geometry?.attributes.position !== undefined;
/** Whether its geometry brings instances of its own. */
export const isInstancedGeometry = ({ geometry }: Mesh): boolean =>
  Boolean((geometry as { isInstancedBufferGeometry?: boolean }).isInstancedBufferGeometry);

/** The points of a geometry: another object, or another version of it, where they are others. */
export function pointsOf(geometry: BufferGeometry): Points {
  const position = geometry.attributes.position as BufferAttribute & { data?: Points };
  return position.data ?? position;
}

/** The sphere by which three culls an object, if it has one of its own. */
export const ownSphereOf = (mesh: Mesh): Sphere | null => (mesh as { boundingSphere?: Sphere | null }).boundingSphere ?? null;

/** A sphere as it was when somebody last looked, none by NaN: they are changed in place, too. */
export class SeenSphere {
  #x = NaN;
  #y = NaN;
  #z = NaN;
  #radius = NaN;

  /** Whether it is another now; takes that over. */
  changes(sphere: Sphere | null): boolean {
    const radius = sphere ? sphere.radius : NaN, x = sphere ? sphere.center.x : NaN;
    const y = sphere ? sphere.center.y : NaN, z = sphere ? sphere.center.z : NaN;
    if (Object.is(radius, this.#radius) && Object.is(x, this.#x) && Object.is(y, this.#y) && Object.is(z, this.#z)) return false;
    this.#radius = radius, (this.#x = x), (this.#y = y), (this.#z = z);
    return true;
  }
}

interface Bounds { points: Points; version: number; given: Box3 | null; sphere: SeenSphere; own: Box3; box: Box3 }
const known = new WeakMap<BufferGeometry, Bounds>();

/** Holds all points, the geometry's own box if it was given one, and the sphere by which three culls it where somebody has made
 * that larger than the points need, as for a shader that moves them. */
export function boxOf(geometry: BufferGeometry): Box3 {
  const points = pointsOf(geometry), { version } = points, made = known.get(geometry);
  const given = geometry.boundingBox, isKnown = made && made.points === points && made.version === version && made.given === given;
  const sphere = made?.sphere ?? new SeenSphere();
  if (!sphere.changes(geometry.boundingSphere) && isKnown) return made.box;
  const own = isKnown ? made.own : boxOfPoints(geometry), box = withSphere(own, geometry.boundingSphere);
  known.set(geometry, { points, version, given, sphere, own, box });
  return box;
}

/** Of a mesh's box one that holds its own sphere, too, by which three culls it instead. */
export const withOwnSphere = (box: Box3, mesh: Mesh): Box3 => withSphere(box, ownSphereOf(mesh));

/** Holds three's sphere around a box. */
export function turned(box: Box3): Box3 {
  return box.isEmpty() ? box : box.clone().union(box.getBoundingSphere(ofBox).getBoundingBox(new Box3()));
}

// What a box says that was given may be older than the points. None is left behind: three would go by it when it casts rays,
// after the points have changed, too.
function boxOfPoints({ boundingBox: given, attributes }: BufferGeometry): Box3 {
  const position = attributes.position as BufferAttribute, box = new Box3();
  if ('getX' in position) box.setFromBufferAttribute(position);
  else if (!given) box.set(new Vector3().setScalar(-Infinity), new Vector3().setScalar(Infinity)); // nobody here knows them
  return given ? box.union(given) : box;
}

const ofBox = new Sphere();
const holds = (outer: Sphere, sphere: Sphere): boolean =>
  outer.center.distanceTo(sphere.center) + sphere.radius <= 1.00001 * outer.radius;

function withSphere(box: Box3, sphere: Sphere | null): Box3 {
  if (!sphere || sphere.radius < 0 || box.isEmpty()) return box;
  // three's own is no larger than that.
  if (holds(box.getBoundingSphere(ofBox), sphere)) return box;
  return box.clone().union(sphere.getBoundingBox(new Box3()));
}

interface Reach { sphere: SeenSphere; box: Box3 | null }
const reaches = new WeakMap<InstancedMesh, Reach>();

/** Has three's sphere made of what has none, as three would now. */
export function measure(mesh: InstancedMesh | BatchedMesh): void {
  if (mesh.boundingSphere !== null) return;
  mesh.computeBoundingSphere();
  if ('isInstancedMesh' in mesh) seenOf(mesh).sphere.changes(mesh.boundingSphere);
}

function seenOf(mesh: InstancedMesh): Reach {
  let reach = reaches.get(mesh);
  if (!reach) reaches.set(mesh, (reach = { sphere: new SeenSphere(), box: null }));
  return reach;
}

/** Where three may draw instances, of which somebody has made the mesh's own sphere larger than they need, as for a shader that
 * moves them; null where it is just what three makes of them. Looked at when it is set: made earlier, it stays three's own. */
export function reachOf(mesh: InstancedMesh): Box3 | null {
  const given = ownSphereOf(mesh), reach = seenOf(mesh);
  if (!reach.sphere.changes(given)) return reach.box;
  reach.box = given && !(given.radius < 0) && !holds(computed(mesh, given), given) ? given.getBoundingBox(new Box3()) : null;
  return reach.box;
}

// What three makes of the instances now; leaves what is there.
function computed(mesh: InstancedMesh, given: Sphere): Sphere {
  const made = (mesh.boundingSphere = new Sphere());
  try {
    mesh.computeBoundingSphere();
    return mesh.boundingSphere ?? made;
  } finally {
    mesh.boundingSphere = given;
  }
}
