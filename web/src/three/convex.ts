// Occluders out of meshes: closed convex ones, which can be drawn a pixel smaller than they are, so that what they hide is
// hidden at every sample of a pixel and at any resolution.
import type { BufferAttribute, BufferGeometry } from 'three';
import type { Batch } from './batches.js';
import { pointsOf, type Points } from './bounds.js';
import { OccluderMesh } from '../occlusion.js';
import { release } from './release.js';

export interface Convex {
  mesh: OccluderMesh;
  /** A point inside, and how far the nearest face is from it. */
  centre: [number, number, number];
  radius: number;
}

const mostTriangles = 200;
interface Parts {
  points: Points; index: BufferAttribute | null; versions: number; made: Map<number, Convex | null>;
  /** How often it was another, and the frame from which on it is looked at. */
  changes: number; from: number;
}
const known = new WeakMap<BufferGeometry, Parts>();
// They lie in the module's memory, where nobody collects them with their geometry.
const collected = new FinalizationRegistry<Parts>((parts) => free(parts));
const disposed = ({ target }: { target: BufferGeometry }) => forgetConvex(target);

let frame = 0;
/** To be called before shapes are asked for in a frame. */
export const beginFrame = (): void => void ++frame;
// A geometry that has changed has no shapes for so many frames, and each time for twice as many: to make them takes longer than
// to draw what they hide.
const pause = (changes: number): number => (changes === 0 ? 0 : 4 << Math.min(changes, 6));

// Of a geometry's vertices or indices from `start` on, made once for as long as they stay.
function part(geometry: BufferGeometry, start: number, corners: number): Convex | null {
  const points = pointsOf(geometry), { index } = geometry, versions = points.version + (index?.version ?? 0);
  let parts = known.get(geometry);
  if (!parts || parts.points !== points || parts.index !== index || parts.versions !== versions) {
    const changes = parts ? parts.changes + 1 : 0;
    forgetConvex(geometry);
    known.set(geometry, (parts = { points, index, versions, made: new Map(), changes, from: frame + pause(changes) }));
    geometry.addEventListener('dispose', disposed), collected.register(geometry, parts, parts);
  }
  if (frame < parts.from) return null;
  let made = parts.made.get(start);
  if (made === undefined) parts.made.set(start, (made = make(geometry, start, corners)));
  return made;
}

/** What is known of a geometry holds no longer. */
export function forgetConvex(geometry: BufferGeometry): void {
  const parts = known.get(geometry);
  if (!parts) return;
  collected.unregister(parts), known.delete(geometry);
  geometry.removeEventListener('dispose', disposed);
  free(parts);
}
function free({ made }: Parts): void {
  for (const convex of made.values()) release(convex?.mesh);
}

/** The geometry as an occluder; null where it is not closed and convex, or has more than 200 triangles. */
export function convexOf(geometry: BufferGeometry): Convex | null {
  const corners = geometry.index?.count ?? geometry.attributes.position!.count;
  const { start, count } = geometry.drawRange;
  return start === 0 && count >= corners ? part(geometry, 0, corners) : null;
}

/** The same of an instance of a batch. */
export function convexOfInstance(mesh: Batch, instance: number): Convex | null {
  const info = mesh._instanceInfo[instance];
  const range = info?.active && info.visible ? mesh._geometryInfo[info.geometryIndex] : undefined;
  return range ? part(mesh.geometry, range.start, range.count) : null;
}

function make(geometry: BufferGeometry, start: number, corners: number): Convex | null {
  const position = geometry.attributes.position!;
  // What lies on the GPU alone cannot be read.
  if (!('getX' in position) || (geometry.index && !('getX' in geometry.index))) return null;
  if (corners % 3 !== 0 || corners > 3 * mostTriangles || corners < 12) return null;
  const all = Array.from({ length: corners }, (_, i) => {
    const v = geometry.index ? geometry.index.getX(start + i) : start + i;
    return [position.getX(v), position.getY(v), position.getZ(v)];
  });
  const { points, names } = join(all), indices = names.flatMap((a, i) => {
    const [b, c] = [names[i + 1]!, names[i + 2]!];
    return i % 3 === 0 && a !== b && b !== c && c !== a ? [a, b, c] : []; // a pole's triangles may have no width
  });
  const inside = measure(points, indices);
  if (!inside) return null;
  return { mesh: new OccluderMesh(Float32Array.from(points), Uint32Array.from(indices), 'front'), ...inside };
}

// Points so near to each other are one, the first: a seam ends at the sine of 2 π, which is not 0 in a computer. Single
// precision, in which all is drawn, is a hundred times as coarse, so no gap opens there, and what the shape gains is far
// below the part of a pixel by which occluders are drawn smaller.
const near = 1e-9;

function join(all: readonly number[][]): { points: number[]; names: number[] } {
  const extents = [0, 1, 2].map((k) => Math.max(...all.map((p) => p[k]!)) - Math.min(...all.map((p) => p[k]!)));
  const most = near * Math.max(...extents), points: number[] = [];
  const names = all.map((p) => {
    const [x, y, z] = p as [number, number, number];
    for (let i = 0; i < points.length; i += 3) {
      if (Math.abs(x - points[i]!) <= most && Math.abs(y - points[i + 1]!) <= most && Math.abs(z - points[i + 2]!) <= most) return i / 3;
    }
    return points.push(x, y, z) / 3 - 1;
  });
  return { points, names };
}

type Inside = Pick<Convex, 'centre' | 'radius'>;

// Null unless every edge has one triangle on each side, and every point lies behind every face.
function measure(points: number[], indices: number[]): Inside | null {
  if (indices.length < 12 || !isClosed(indices)) return null;
  const centre: [number, number, number] = [0, 0, 0];
  for (let i = 0; i < points.length; ++i) centre[i % 3]! += (points[i]! * 3) / points.length;
  const size = Math.max(...points.map((x, i) => Math.abs(x - centre[i % 3]!)));
  let radius = Infinity;
  for (let t = 0; t < indices.length; t += 3) {
    const face = faceOf(points, 3 * indices[t]!, 3 * indices[t + 1]!, 3 * indices[t + 2]!);
    if (!(face.length > 1e-12 * size * size)) return null;
    for (let p = 0; p < points.length; p += 3)
      if (above(face, points[p]!, points[p + 1]!, points[p + 2]!) > 1e-6 * size) return null;
    radius = Math.min(radius, -above(face, ...centre));
  }
  return radius > 1e-3 * size ? { centre, radius } : null;
}

// Whether each edge is there once in either direction.
function isClosed(indices: number[]): boolean {
  const edges = new Set<number>(), many = 3 * mostTriangles, name = (a: number, b: number): number => a * many + b;
  const next = (i: number): number => indices[i % 3 === 2 ? i - 2 : i + 1]!;
  for (let i = 0; i < indices.length; ++i) edges.add(name(indices[i]!, next(i)));
  return edges.size === indices.length && indices.every((a, i) => edges.has(name(next(i), a)));
}

// A triangle's normal, how long that is, and the triangle's first corner.
interface Face { x: number; y: number; z: number; length: number; at: [number, number, number] }
function faceOf(p: number[], a: number, b: number, c: number): Face {
  const ux = p[b]! - p[a]!, uy = p[b + 1]! - p[a + 1]!, uz = p[b + 2]! - p[a + 2]!;
  const vx = p[c]! - p[a]!, vy = p[c + 1]! - p[a + 1]!, vz = p[c + 2]! - p[a + 2]!;
  const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
  return { x, y, z, length: Math.hypot(x, y, z), at: [p[a]!, p[a + 1]!, p[a + 2]!] };
}

const above = ({ x, y, z, length, at }: Face, px: number, py: number, pz: number): number =>
  (x * (px - at[0]) + y * (py - at[1]) + z * (pz - at[2])) / length;
