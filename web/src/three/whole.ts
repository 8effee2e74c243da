// When a scene is left to three as it is: everything in it was in view and nothing hidden, and all views still hold the
// box of all that. That costs a frame next to nothing, and is always sound: three draws what it would without a culler.
import type { Camera } from 'three';
import type { Inventory } from './inventory.js';
import type { Eye } from './occluders.js';
import { moves } from './things.js';

const fewestFrames = 16, mostFrames = 256;
/** What culling must drop to be worth a frame's work: a thirty-second. */
const worth = 32;

export class Whole {
  #box: Float64Array | undefined;
  #eye: ArrayLike<number> = [];
  #occlusion = false;
  // The camera that it stood for last: what moves() compares of its view and of its projection, and the latter's last row.
  readonly #camera = new Float64Array(28);
  // Until somebody looks again, and how many the last time.
  #frames = 0;
  #last = 0;

  /** Whether it is, as the last frame was, for a camera that has not moved since; where no light throws shadows. */
  standsStill(camera: Camera, occlusion: boolean): boolean {
    if (!this.#box || this.#frames === 0 || occlusion !== this.#occlusion) return false;
    const { elements: p } = camera.projectionMatrix, known = this.#camera;
    const isMoved = moves(known, 0, camera.matrixWorldInverse.elements), isOther = moves(known, 12, p);
    const same = !isMoved && !isOther && known[24] === p[3] && known[25] === p[7] && known[26] === p[11] && known[27] === p[15];
    known[24] = p[3], (known[25] = p[7]), (known[26] = p[11]), (known[27] = p[15]);
    if (same) --this.#frames;
    return same;
  }

  /** Whether the scene is left as it is in this frame. */
  stands(viewsOf: () => readonly Eye[], occlusion: boolean): boolean {
    const box = this.#box;
    if (!box || this.#frames === 0) return false;
    const views = viewsOf();
    const stays = occlusion === this.#occlusion && isNear(views[0]!.origin, this.#eye, box) &&
      views.every((view) => holds(view, box));
    if (stays) return --this.#frames, true;
    this.#box = undefined, (this.#last = 0), this.#camera.fill(NaN);
    return false;
  }

  /** Takes over what a frame's views have left of all things, the eye's first. */
  look({ size, boxes }: Inventory, eye: Eye, occlusion: boolean, seen: readonly Uint32Array[]): void {
    this.#box = undefined, this.#camera.fill(NaN);
    if (seen.some(({ length }) => worth * (size - length) > size)) return void (this.#last = 0);
    this.#box = boundsOf(boxes.array, seen[0]!);
    this.#eye = Array.from(eye.origin), (this.#occlusion = occlusion);
    this.#frames = this.#last = Math.min(Math.max(2 * this.#last, fewestFrames), mostFrames);
  }
}

function boundsOf(boxes: Float64Array, slots: Uint32Array): Float64Array {
  const bounds = new Float64Array(6).fill(Infinity, 0, 3).fill(-Infinity, 3);
  for (const slot of slots) {
    for (let axis = 0; axis < 3; ++axis) {
      bounds[axis] = Math.min(bounds[axis]!, boxes[6 * slot + axis]!);
      bounds[3 + axis] = Math.max(bounds[3 + axis]!, boxes[6 * slot + 3 + axis]!);
    }
  }
  return bounds;
}

// Whether an eye has not gone so far that others may hide now.
function isNear(a: ArrayLike<number>, b: ArrayLike<number>, box: Float64Array): boolean {
  const far = (p: (axis: number) => number) => Math.hypot(p(0), p(1), p(2));
  return far((axis) => a[axis]! - b[axis]!) <= far((axis) => box[3 + axis]! - box[axis]!) / worth;
}

// Whether a view holds a box: it lies whole on the inner side of each plane.
function holds({ worldToEye: m, eyeToClip: p, origin }: Eye, box: Float64Array): boolean {
  const rows = new Float64Array(16); // from the world to clip space
  for (let row = 0; row < 4; ++row) {
    for (let column = 0; column < 4; ++column)
      for (let k = 0; k < 4; ++k) rows[4 * row + column] = rows[4 * row + column]! + p[4 * k + row]! * m[4 * column + k]!;
  }
  const least = (sign: number, row: number, w: number) => {
    let sum = 0;
    for (let axis = 0; axis < 4; ++axis) {
      const n = sign * rows[4 * row + axis]! + w * rows[12 + axis]!;
      sum += axis === 3 ? n : n * (box[axis + (n > 0 ? 0 : 3)]! - origin[axis]!);
    }
    return sum;
  };
  return least(1, 0, 1) >= 0 && least(-1, 0, 1) >= 0 && least(1, 1, 1) >= 0 && least(-1, 1, 1) >= 0 &&
    least(1, 2, 0) >= 0 && least(-1, 2, 1) >= 0;
}
