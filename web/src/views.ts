// Views as the library lays them out: WorldView of 160 bytes, CullView of 184.
import { refuse, said } from './errors.js';
import { fields, readNumbers, readOrigin } from './memory.js';
import { buffer } from './runtime.js';

/** A camera. Matrices are column-major and multiply columns, as in three.js and glTF. */
export interface View {
  /** 16 numbers, rigid; the eye looks down its own -z (three: camera.matrixWorldInverse). */
  worldToEye: ArrayLike<number>;
  /** 16 numbers, the projection; clip depth is 0 to 1, either way round (see clipZeroToOne). */
  eyeToClip: ArrayLike<number>;
  /** Pixels of the image. */
  width: number;
  height: number;
  /** The view sees the world moved by -origin, in double precision, so that far away its matrices stay precise. */
  origin?: ArrayLike<number>;
}

export const viewBytes = 160;
export const cullViewBytes = 184;

/** A projection whose clip depth is -1 to 1, as WebGL has it, as one whose depth is 0 to 1. */
export function clipZeroToOne(projection: ArrayLike<number>): number[] {
  const made = readNumbers('clipZeroToOne', 'a projection', projection, 16);
  for (let column = 0; column < 4; ++column) made[4 * column + 2] = (made[4 * column + 2]! + made[4 * column + 3]!) / 2;
  return made;
}

/** A view that was read and is sound as far as is seen from here. */
export interface ReadView { worldToEye: number[]; eyeToClip: number[]; width: number; height: number; origin: number[] }

export function readView(what: string, view: View): ReadView {
  const [worldToEye, eyeToClip, width, height, origin = [0, 0, 0]] =
    fields(what, view, ['worldToEye', 'eyeToClip', 'width', 'height', 'origin'], 'bad_view');
  const read = {
    worldToEye: readNumbers(what, 'a view\'s worldToEye', worldToEye, 16, 'bad_view'),
    eyeToClip: readNumbers(what, 'a view\'s eyeToClip', eyeToClip, 16, 'bad_view'),
    width: width!, height: height!, origin: readOrigin(what, origin, 'bad_view') };
  for (const side of [read.width, read.height]) {
    if (!Number.isInteger(side) || side < 1 || side > 16384)
      refuse(`${what}: an image of ${said(width)} x ${said(height)}, expected 1 to 16384 pixels a side`, 'bad_view');
  }
  return read;
}

/** Writes a view to the module's memory. */
export function writeView({ worldToEye, eyeToClip, width, height, origin }: ReadView, pointer: number): void {
  const floats = new Float32Array(buffer(), pointer, 32);
  floats.set(worldToEye), floats.set(eyeToClip, 16);
  const data = new DataView(buffer(), pointer, viewBytes);
  data.setUint32(128, width, true), data.setUint32(132, height, true);
  for (let axis = 0; axis < 3; ++axis) data.setFloat64(136 + 8 * axis, origin[axis]!, true);
}
