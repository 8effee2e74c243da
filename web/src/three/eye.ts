// Cameras of three.js as the library sees them.
import type { Camera } from 'three';
import { clipZeroToOne } from '../views.js';
import { determinantOf, type Eye } from './occluders.js';

// How far before the eye, in metres along the view, the nearer of the two planes lies that cut by depth. A camera's own `near`
// says nothing of a matrix that was set by hand.
function nearOf(p: readonly number[]): number {
  const isFlat = p[15] === 1;
  const planes = [p[14]! / p[10]!, (p[14]! - p[15]!) / (p[10]! - p[11]!)].filter((at) => Number.isFinite(at) && (isFlat || at > 0));
  return Math.min(...planes); // of none nothing is surely before it
}

/** A camera as the library sees it, about its own place. */
export function eyeOf(camera: Camera, width: number, most = 4096): Eye {
  const m = camera.matrixWorldInverse.elements, world = camera.matrixWorld.elements;
  const origin = [world[12]!, world[13]!, world[14]!];
  const worldToEye = Array.from(m);
  for (let row = 0; row < 3; ++row)
    worldToEye[12 + row] = m[row]! * origin[0]! + m[4 + row]! * origin[1]! + m[8 + row]! * origin[2]! + m[12 + row]!;
  const { coordinateSystem, projectionMatrix, reversedDepth } = camera as Camera & { reversedDepth?: boolean };
  const p = projectionMatrix.elements;
  const eyeToClip = coordinateSystem === 2001 || reversedDepth ? Array.from(p) : clipZeroToOne(p);
  const aspect = Math.abs(p[5]! / p[0]!);
  const height = Math.min(Math.max(Math.round(width / aspect), 1), most);
  return { worldToEye, eyeToClip, origin, width, height, near: nearOf(eyeToClip) };
}

// Whether a metre in the world is one for the eye, and the fronts of faces are what it is shown, as occlusion takes it to be.
export function isRigid({ worldToEye: m, eyeToClip: p }: Eye): boolean {
  return determinantOf(m) * p[0]! * p[5]! > 0 && [0, 1, 2].every((row) => Math.abs(Math.hypot(m[row]!, m[4 + row]!, m[8 + row]!) - 1) < 1e-5);
}
