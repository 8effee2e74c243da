// Many matrices as they were when somebody last looked, and which of them are others now.
import { floats, integers, type Block } from '../memory.js';
import { wasm } from '../runtime.js';

const atOnce = 1024; // what is compared at once stays in the processor's cache
let room: { now: Block<Float32Array>; moved: Block<Uint32Array> } | undefined;

export class Matrices {
  readonly #known: Block<Float32Array>;

  constructor(count: number) {
    this.#known = floats(16 * count);
    room ??= { now: floats(16 * atOnce), moved: integers(atOnce) };
  }
  dispose(): void {
    this.#known.dispose();
  }

  /** Takes all over. */
  takeAll(now: Float32Array): void {
    this.#known.array.set(now.subarray(0, this.#known.length));
  }
  /** Takes over the matrix at i. */
  take(now: Float32Array, i: number): void {
    const known = this.#known.array;
    for (let k = 16 * i; k < 16 * i + 16; ++k) known[k] = now[k]!;
  }
  /** Takes over what is another from the matrix at `first` to before `end`, and tells which. */
  compare(now: Float32Array, first: number, end: number, tell: (i: number) => void): void {
    const { now: part, moved } = room!;
    for (let at = first; at < end; at += atOnce) {
      const count = Math.min(atOnce, end - at);
      part.array.set(now.subarray(16 * at, 16 * (at + count)));
      const found = wasm().moved_matrices!(part.pointer, this.#known.pointer + 64 * at, count, moved.pointer);
      for (let k = 0; k < found; ++k) tell(at + moved.array[k]!);
    }
  }
}
