// Bounds of geometries, which are made anew where their points have changed.
import { Box3, Sphere, Vector3 } from 'three';
import type { BufferAttribute, BufferGeometry } from 'three';

/** What has a version of a geometry's points. */
export interface Points { version: number }

/** The points of a geometry: another object, or another version of it, where they are others. */
export function pointsOf(geometry: BufferGeometry): Points {
  const position = geometry.attributes.position as BufferAttribute & { data?: Points };
  return position.data ?? position;
}

interface Bounds { points: Points; version: number; given: Box3 | null; radius: number | undefined; own: Box3; box: Box3 }
const known = new WeakMap<BufferGeometry, Bounds>();

/** Holds all points, the geometry's own box if it was given one, and the sphere by which three culls it where somebody has made
 * that larger than the points need, as for a shader that moves them. */
export function boxOf(geometry: BufferGeometry): Box3 {
  const points = pointsOf(geometry), { version } = points, made = known.get(geometry), radius = geometry.boundingSphere?.radius;
  const given = geometry.boundingBox, isKnown = made && made.points === points && made.version === version && made.given === given;
  if (isKnown && made.radius === radius) return made.box;
  const own = isKnown ? made.own : boxOfPoints(geometry), box = withSphere(own, geometry.boundingSphere);
  known.set(geometry, { points, version, given, radius, own, box });
  return box;
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

function withSphere(box: Box3, sphere: Sphere | null): Box3 {
  if (!sphere || !(sphere.radius >= 0) || box.isEmpty()) return box;
  box.getBoundingSphere(ofBox);
  // three's own is no larger than that.
  if (ofBox.center.distanceTo(sphere.center) + sphere.radius <= 1.00001 * ofBox.radius) return box;
  return box.clone().union(sphere.getBoundingBox(new Box3()));
}
