// Visible sets that were baked for the cells of a grid, as arrays. (The library's files are packed with zstd, which
// browsers do not unpack: read them with Python's read_pvs and write its arrays.)
import { refuse, refuseProxy, said } from './errors.js';
import { fields, lengthOf, readNumbers, truly } from './memory.js';

/** As CellPvs of <sightline/pvs.hpp>. Cells run x first, then y, then z. */
export interface PvsArrays {
  /** Of all cells together, in metres: minimum x, y, z, maximum x, y, z. */
  bounds: ArrayLike<number>;
  /** Cells along x, y and z. */
  counts: ArrayLike<number>;
  /** Objects of the scene. */
  objects: number;
  /** One a cell: 0 where nobody can be. */
  open: Uint8Array;
  /** Cell c's objects are visible[first[c]] to visible[first[c + 1] - 1]. */
  first: Uint32Array;
  /** Ascending within a cell. */
  visible: Uint32Array;
}

/** Sets to ask. */
export class CellPvs {
  readonly #arrays: PvsArrays;
  readonly #lengths: number[]; // of open, first and visible

  constructor(arrays: PvsArrays) {
    const [box, along, objects, open, first, visible] =
      fields('CellPvs', arrays, ['bounds', 'counts', 'objects', 'open', 'first', 'visible']);
    if (!([open, first, visible].every(ArrayBuffer.isView) && open instanceof Uint8Array && first instanceof Uint32Array &&
      visible instanceof Uint32Array)) refuse('CellPvs: expected open as a Uint8Array, first and visible as Uint32Arrays');
    // In single precision, as points are asked.
    const bounds = readNumbers('CellPvs', 'bounds', box, 6).map(Math.fround), counts = readNumbers('CellPvs', 'counts', along, 3);
    if (!Number.isInteger(objects) || objects! < 0) refuse(`CellPvs: ${said(objects)} objects, expected a whole number of them`);
    const cells = counts[0]! * counts[1]! * counts[2]!;
    for (let axis = 0; axis < 3; ++axis) {
      const extent = bounds[3 + axis]! - bounds[axis]!;
      if (!(extent > 0 && extent < Infinity) || !Number.isInteger(counts[axis]) || counts[axis]! < 1)
        refuse('CellPvs: bounds without extent in single precision or a count below 1, expected minimum < maximum and whole cells');
    }
    const lengths = [open, first, visible].map(lengthOf);
    if (lengths[0] !== cells || lengths[1] !== cells + 1)
      refuse(`CellPvs: ${lengths[0]} open and ${lengths[1]} first for ${cells} cells, expected one each and one more`);
    if (first[0] !== 0 || first[cells] !== lengths[2])
      refuse('CellPvs: first does not run from 0 to the length of visible');
    for (let c = 0; c < cells; ++c) {
      if (first[c]! > first[c + 1]!) refuse(`CellPvs: first falls at cell ${c}, expected it to rise`);
      for (let i = first[c]!; i < first[c + 1]!; ++i) {
        if (visible[i]! >= objects! || (i > first[c]! && visible[i]! <= visible[i - 1]!))
          refuse(`CellPvs: the set of cell ${c} does not ascend below ${objects}`);
      }
    }
    this.#arrays = { bounds, counts, objects: objects!, open, first, visible }, (this.#lengths = lengths);
  }

  static #of(set: CellPvs): PvsArrays {
    if (!(#arrays in Object(set))) refuseProxy('CellPvs');
    const { open, first, visible } = set.#arrays;
    if ([open, first, visible].some((array, i) => truly(array, 'length') < set.#lengths[i]!))
      refuse('CellPvs: an array was transferred or shrunk, expected it to stay', 'detached');
    return set.#arrays;
  }

  /** The open cell that holds the point, or undefined. */
  cellAt(x: number, y: number, z: number): number | undefined {
    const { bounds, counts, open } = CellPvs.#of(this);
    let cell = 0, step = 1;
    for (const [axis, at] of [x, y, z].entries()) {
      const low = bounds[axis]!, high = bounds[3 + axis]!, count = counts[axis]!;
      if (typeof at !== 'number') refuse(`cellAt: a coordinate of ${said(at)}, expected a number`);
      const p = Math.fround(at);
      if (!(p >= low && p <= high)) return undefined;
      const along = Math.min(Math.floor(((p - low) / (high - low)) * count), count - 1);
      cell += along * step;
      step *= count;
    }
    return open[cell] ? cell : undefined;
  }
  /** The objects of a cell, ascending. */
  seenFrom(cell: number): Uint32Array {
    const { first, open, visible } = CellPvs.#of(this);
    if (!Number.isInteger(cell) || cell < 0 || cell >= open.length)
      refuse(`seenFrom: cell ${said(cell)}, expected an integer below ${open.length}`);
    return visible.subarray(first[cell]!, first[cell + 1]!);
  }
}
