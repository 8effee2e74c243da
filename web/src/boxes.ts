// Boxes as calls take them.
import { refuse, said } from './errors.js';
import { Block, expectNames, fields, lengthOf, readOrigin, type Call, type Input, type Sized } from './memory.js';

/** Boxes in an array, in metres. Single precision may be about an `origin`. */
export interface BoxArray {
  data: Input<Float32Array> | Input<Float64Array>;
  /** `min-max`: minimum x, y, z, maximum x, y, z, box after box. `centre-half`: centre and half size so. `columns`, of single
   * precision: all minimum x, all minimum y …; the fastest to cull flat. */
  layout?: 'min-max' | 'centre-half' | 'columns';
  /** Numbers from a box to the next: 6, unless set. */
  stride?: number;
  /** What single precision counts from. */
  origin?: ArrayLike<number>;
}
/** An array alone is `min-max`. */
export type Boxes = BoxArray | Input<Float32Array> | Input<Float64Array>;

const names = ['data', 'layout', 'stride', 'origin'] as const;
const layouts = ['min-max', 'centre-half', 'columns'];

/** How many there are, where they are to be placed, and the flat arguments a call takes. */
export function readBoxes(what: string, boxes: Boxes): {
  data: Sized;
  count: number;
  args: (pointer: number) => [number, number, number, number, number, number, number];
} {
  const given: BoxArray = Block.is(boxes) || ArrayBuffer.isView(boxes) ? { data: boxes as Input<Float32Array> } : boxes;
  const [array, layout = 'min-max', stride = 6, from = [0, 0, 0]] = fields(what, given, [...names]);
  const data = array!;
  const kind = Block.is(data) ? data.kind : ArrayBuffer.isView(data) ? data.constructor : undefined;
  if (kind !== Float32Array && kind !== Float64Array)
    refuse(`${what}: expected boxes as a Float32Array, a Float64Array or a Block of one`);
  expectNames(what, given, names);
  const form = layouts.indexOf(layout);
  if (form < 0) refuse(`${what}: a layout of ${said(layout)}, expected ${layouts.join(', ')}`);
  const double = kind === Float64Array;
  if (form === 2 && double) refuse(`${what}: columns of double precision, expected single`);
  // The module would take its bytes modulo 2^32.
  if (!Number.isInteger(stride) || stride < 6 || stride > 2 ** 28)
    refuse(`${what}: a stride of ${said(stride)}, expected an integer from 6 to 2^28`);
  const origin = readOrigin(what, from);
  const step = form === 2 ? 6 : stride;
  const length = lengthOf(data), count = length && (length + step - 6) / step;
  if (!Number.isInteger(count)) refuse(`${what}: ${length} numbers, expected a multiple of ${step}`);
  return {
    data: [data, length],
    count,
    args: (pointer) =>
      [2 * form + (double ? 1 : 0), pointer, step * (double ? 8 : 4), count, origin[0]!, origin[1]!, origin[2]!],
  };
}

/** The same, placed. */
export function placeBoxes(what: string, call: Call, boxes: Boxes): { count: number; args: number[] } {
  const read = readBoxes(what, boxes);
  const [pointer] = call.place(read.data);
  return { count: read.count, args: read.args(pointer!) };
}
