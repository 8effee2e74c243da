// Bounds of geometries, which are made anew where their points have changed.
import { Box3 } from 'three';
import type { BufferAttribute, BufferGeometry } from 'three';

/** What has a version of a geometry's points. */
export interface Points { version: number }

/** The points of a geometry: another object, or another version of it, where they are others. */
export function pointsOf(geometry: BufferGeometry): Points {
  const position = geometry.attributes.position as BufferAttribute & { data?: Points };
  return position.data ?? position;
}

interface Bounds { points: Points; version: number; box: Box3 }
const known = new WeakMap<BufferGeometry, Bounds>();

/** Holds all points. The geometry's own box is taken for it until the points change; from then on it holds them, too. */
export function boxOf(geometry: BufferGeometry): Box3 {
  const points = pointsOf(geometry), { version } = points, made = known.get(geometry);
  if (made && made.points === points && made.version === version && geometry.boundingBox !== null) return made.box;
  const isGiven = geometry.boundingBox !== null;
  if (!isGiven) geometry.computeBoundingBox();
  const box = geometry.boundingBox!.clone(), position = geometry.attributes.position as BufferAttribute;
  if (made && isGiven && 'getX' in position) box.union(new Box3().setFromBufferAttribute(position));
  known.set(geometry, { points, version, box });
  return box;
}
