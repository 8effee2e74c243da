// The views of a light that throws shadows, and which of them three is about to draw. Whom three asks for them is another matter
// in other versions: lights by the view's number up to 0.185, by the camera that draws since; it places the sides of point
// lights by itself since 0.182. How the camera stands tells the views apart in all of them.
import { Vector3 } from 'three';
import type { Camera, Light, LightShadow, PerspectiveCamera } from 'three';
import { eyeOf } from './eye.js';
import type { Eye } from './occluders.js';

export type ShadowLight = Light & { shadow: LightShadow };
type Shadow = Omit<LightShadow, 'updateMatrices'> & {
  getCamera?(viewport: number): Camera;
  updateMatrices(light: Light, by: number | Camera): void;
};

// Where three looks from a point light, and what is up there.
const sides = [[1, 0, 0, 0, -1, 0], [-1, 0, 0, 0, -1, 0], [0, 1, 0, 0, 0, 1], [0, -1, 0, 0, 0, -1], [0, 0, 1, 0, -1, 0], [0, 0, -1, 0, -1, 0]];
const target = new Vector3();

/** All views of a light, for the camera that draws. */
export function viewsOf(light: ShadowLight, drawing: Camera): Eye[] {
  const shadow = light.shadow as unknown as Shadow, camera = shadow.camera as PerspectiveCamera, count = shadow.getViewportCount();
  // As three does where it has yet to make the map.
  if (!shadow.map) camera.updateProjectionMatrix();
  if ((light as { isPointLight?: boolean }).isPointLight && count < sides.length) return sides.map((side) => look(light, camera, side, shadow));
  if (shadow.getCamera) shadow.updateMatrices(light, drawing);
  return Array.from({ length: count }, (_, viewport) => {
    if (!shadow.getCamera) shadow.updateMatrices(light, viewport);
    return viewOf(light, viewport);
  });
}

function look(light: ShadowLight, camera: PerspectiveCamera, [x, y, z, ...up]: number[], { mapSize }: Shadow): Eye {
  const far = (light as { distance?: number }).distance || camera.far;
  if (far !== camera.far) (camera.far = far), camera.updateProjectionMatrix();
  camera.position.setFromMatrixPosition(light.matrixWorld);
  camera.up.fromArray(up), camera.lookAt(target.set(x!, y!, z!).add(camera.position)), camera.updateMatrixWorld();
  return eyeOf(camera, mapSize.x);
}

/** The view as its camera stands. */
export function viewOf({ shadow }: ShadowLight, viewport = 0): Eye {
  return eyeOf((shadow as unknown as Shadow).getCamera?.(viewport) ?? shadow.camera, shadow.mapSize.x);
}

/** Whether two views show the same; how they count depth may be settled only just before three draws. */
export const isSameView = (a: Eye, b: Eye): boolean => isSame(a.worldToEye, b.worldToEye) && isSame(a.origin, b.origin) &&
  Array.from(a.eyeToClip).every((x, i) => i % 4 === 2 || x === b.eyeToClip[i]);
const isSame = (a: ArrayLike<number>, b: ArrayLike<number>): boolean => Array.from(a).every((x, i) => x === b[i]);
