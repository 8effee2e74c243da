// World-space boxes of what matrices move, in double precision, a little larger than they are.
import type { Box3 } from 'three';

/** As far from 0 as a World takes boxes and views. */
const reach = 1e11;

/** Writes the box of `local` moved by `m` and then by `n`, if any, at 6 · slot; returns whether it is another than before. */
export function writeBox(out: Float64Array, slot: number, local: Box3, m: ArrayLike<number>, at: number,
  n?: ArrayLike<number>): boolean {
  const { min, max } = local;
  let changed = false, sound = min.x <= max.x;
  for (let row = 0; row < 3; ++row) {
    let a = m[at + row]!, b = m[at + 4 + row]!, c = m[at + 8 + row]!, d = m[at + 12 + row]!;
    if (n) {
      const [x, y, z] = [n[row]!, n[4 + row]!, n[8 + row]!];
      a = x * m[at]! + y * m[at + 1]! + z * m[at + 2]!;
      b = x * m[at + 4]! + y * m[at + 5]! + z * m[at + 6]!;
      c = x * m[at + 8]! + y * m[at + 9]! + z * m[at + 10]!;
      d = x * m[at + 12]! + y * m[at + 13]! + z * m[at + 14]! + n[12 + row]!;
    }
    let low = d, high = d;
    if (a < 0) (low += a * max.x), (high += a * min.x);
    else (low += a * min.x), (high += a * max.x);
    if (b < 0) (low += b * max.y), (high += b * min.y);
    else (low += b * min.y), (high += b * max.y);
    if (c < 0) (low += c * max.z), (high += c * min.z);
    else (low += c * min.z), (high += c * max.z);
    // What single precision on the GPU can move a corner by.
    const size = Math.max(Math.abs(low), Math.abs(high), Math.abs(d));
    low -= 2e-6 * size, high += 2e-6 * size;
    if (!(low >= -reach && high <= reach)) sound = false;
    const first = 6 * slot + row;
    if (out[first] !== low || out[first + 3] !== high) (changed = true), (out[first] = low), (out[first + 3] = high);
  }
  // Nothing is known of it: it is everywhere that a camera may be.
  if (!sound) out.fill(-reach, 6 * slot, 6 * slot + 3).fill(reach, 6 * slot + 3, 6 * slot + 6);
  return changed;
}

// Where a box stands of which nothing is drawn: out of every view that has an end.
const nowhere = 0.9 * reach;
/** Whether the box at 6 · slot stands there. */
export const isNowhere = (boxes: Float64Array, slot: number): boolean => boxes[6 * slot] === nowhere && boxes[6 * slot + 3] === nowhere;
/** Puts boxes from … to - 1 there. */
export const putNowhere = (boxes: Float64Array, from: number, to: number): void => void boxes.fill(nowhere, 6 * from, 6 * to);

/** Makes the box at 6 · slot hold another one, too. */
export function widen(out: Float64Array, slot: number, by: Float64Array): void {
  for (let k = 6 * slot, axis = 0; axis < 3; ++axis, ++k) {
    out[k] = Math.min(out[k]!, by[axis]!);
    out[k + 3] = Math.max(out[k + 3]!, by[axis + 3]!);
  }
}
