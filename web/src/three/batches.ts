// What a BatchedMesh keeps inside, and what it is told: three keeps no note of which of its instances have moved, so the
// methods that move them take one.
import type { BatchedMesh, Box3, Sphere } from 'three';
import { forgetConvex } from './convex.js';
import { restore } from './restore.js';

export interface DataTexture<T> {
  version: number;
  needsUpdate: boolean;
  image: { data: T; width: number };
  updateRanges?: unknown[];
}

/** What three keeps of a batch; without it (it may be named otherwise one day) a batch is drawn as three would. */
export interface BatchInside {
  _instanceInfo: { visible: boolean; active: boolean; geometryIndex: number }[];
  _geometryInfo: { start: number; count: number; boundingBox: Box3 | null; boundingSphere: Sphere | null }[];
  _matricesTexture: DataTexture<Float32Array>;
  _multiDrawStarts: Int32Array;
  _multiDrawCounts: Int32Array;
  _multiDrawCount: number;
  _indirectTexture: DataTexture<Uint32Array>;
  _visibilityChanged: boolean;
}
export type Batch = BatchedMesh & BatchInside;

const inside = ['_instanceInfo', '_geometryInfo', '_matricesTexture', '_multiDrawStarts', '_multiDrawCounts',
  '_multiDrawCount', '_indirectTexture', '_visibilityChanged'];
export const isKnownInside = (batch: Batch): boolean => inside.every((name) => name in batch);

/** What a batch was told since somebody last looked. */
export interface Told {
  /** Instances that were given a matrix or another geometry, some more than once. */
  instances: number[];
  /** How often that counted the matrices' version up. */
  versions: number;
  /** All may have changed. */
  all: boolean;
}

type Method = (this: unknown, ...all: never[]) => unknown;

function note(told: Told, batch: Batch, instance: number): void {
  if (told.all) return;
  if (told.instances.length < batch.maxInstanceCount) told.instances.push(instance);
  else told.instances.length = 0, (told.all = true); // nobody has looked for long
}
function noteAll(told: Told): void {
  told.all = true, (told.instances.length = 0);
}
// By the method's first argument and what it returned.
const notes: Record<string, (told: Told, batch: Batch, first: number, returned: number) => void> = {
  setMatrixAt(told, batch, instance) { ++told.versions, note(told, batch, instance); },
  addInstance(told, batch, _, instance) { ++told.versions, note(told, batch, instance); },
  setGeometryIdAt: note,
  deleteInstance: note,
  setGeometryAt: noteAll,
  deleteGeometry: noteAll,
  optimize(told, { geometry }) { forgetConvex(geometry), noteAll(told); },
};

interface Ear { tolds: Set<Told>; own: Map<string, [Method, PropertyDescriptor | undefined]> }
const ears = new WeakMap<Batch, Ear>();

/** Takes notes from now on, until unlisten(). */
export function listen(batch: Batch): Told {
  const told: Told = { instances: [], versions: 0, all: true };
  let ear = ears.get(batch);
  if (!ear) ears.set(batch, (ear = { tolds: new Set(), own: new Map() }));
  ear.tolds.add(told);
  if (ear.own.size > 0) return told;
  const methods = batch as unknown as Record<string, Method>, { tolds } = ear;
  for (const [name, take] of Object.entries(notes)) {
    const method = methods[name]!, own = Object.getOwnPropertyDescriptor(batch, name);
    const noted = function (this: unknown, ...all: never[]) {
      const returned = method.apply(this, all);
      for (const each of tolds) take(each, batch, all[0] as unknown as number, returned as number);
      return returned;
    };
    methods[name] = noted;
    ear.own.set(name, [noted, own]);
  }
  return told;
}

export function unlisten(batch: Batch, told: Told): void {
  const ear = ears.get(batch);
  if (!ear?.tolds.delete(told) || ear.tolds.size > 0) return;
  // What somebody else has put over ours stays, and ours below it takes no more notes.
  for (const [name, [noted, own]] of ear.own)
    if ((batch as unknown as Record<string, Method>)[name] === noted) restore(batch, name, own);
  ears.delete(batch);
}
