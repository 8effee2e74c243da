// Typed arrays that lie in the module's memory, and how calls take these and all others.
import { refuse, refuseProxy, said, type Code } from './errors.js';
import { buffer, wasm } from './runtime.js';

export type Numbers = Float32Array | Float64Array | Uint32Array | Uint8Array;
const kinds: readonly unknown[] = [Float32Array, Float64Array, Uint32Array, Uint8Array];
type Kind<T extends Numbers> = { new (buffer: ArrayBufferLike, offset: number, length: number): T; BYTES_PER_ELEMENT: number };

const typedArray = Object.getPrototypeOf(Uint8Array.prototype) as Uint8Array;
/** What typed arrays are, whatever stands on one under the same name. */
export const truly = <K extends 'buffer' | 'byteOffset' | 'byteLength' | 'length'>(array: Numbers, name: K): Numbers[K] =>
  Reflect.get(typedArray, name, array) as Numbers[K];

// 0 where there is no room; the module itself would take the size modulo 2^32.
const allocate = (size: number): number => (size < 2 ** 32 - 64 ? wasm().allocate!(Math.max(size, 64)) >>> 0 : 0);

/** A typed array in the module's memory: the library reads and writes it where it is. */
export class Block<T extends Numbers> {
  readonly length: number;
  /** @internal */
  readonly kind: Kind<T>;
  #pointer: number;
  #array: T | undefined;

  constructor(kind: Kind<T>, length: number) {
    if (!kinds.includes(kind)) refuse('Block: expected Float32Array, Float64Array, Uint32Array or Uint8Array');
    if (!Number.isInteger(length) || length < 0 || length > 2 ** 31)
      refuse(`Block: a length of ${said(length)}, expected an integer from 0 to 2^31`);
    this.kind = kind;
    this.length = length;
    this.#pointer = allocate(length * kind.BYTES_PER_ELEMENT);
    if (this.#pointer === 0) refuse(`Block: no memory for ${length} numbers`, 'too_many');
    Object.freeze(this); // a length that was written would have calls write beyond
  }
  /** @internal Not what merely claims to be one, as a Proxy of one does. */
  static is(given: unknown): given is Block<Numbers> {
    return typeof given === 'object' && given !== null && #pointer in given;
  }
  /** @internal */
  get pointer(): number {
    if (!Block.is(this)) refuseProxy('Block');
    if (this.#pointer === 0) refuse('Block: used after dispose()', 'disposed');
    return this.#pointer;
  }
  /** The array. Fetch it anew each frame: one that was fetched before the memory grew is empty, and refused. */
  get array(): T {
    const { pointer } = this;
    if (this.#array?.buffer !== buffer()) this.#array = new this.kind(buffer(), pointer, this.length);
    return this.#array;
  }
  /** Gives the memory back. */
  dispose(): void {
    if (!Block.is(this)) refuseProxy('Block');
    if (this.#pointer !== 0) wasm().release!(this.#pointer);
    this.#pointer = 0;
  }
}

/** `length` numbers of single precision in the module's memory. */
export const floats = (length: number): Block<Float32Array> => new Block(Float32Array, length);
/** `length` numbers of double precision in the module's memory: handles, boxes far away. */
export const doubles = (length: number): Block<Float64Array> => new Block(Float64Array, length);
/** `length` integers of 32 bits in the module's memory: layers, values, indices. */
export const integers = (length: number): Block<Uint32Array> => new Block(Uint32Array, length);
/** `length` bytes in the module's memory. */
export const bytes = (length: number): Block<Uint8Array> => new Block(Uint8Array, length);

/** An array of numbers: a Block, or any typed array, which is copied unless it lies in the module's memory. */
export type Input<T extends Numbers> = T | Block<T>;

/** An array for a call, and how many of its numbers the call reads. */
export type Sized = [input: Input<Numbers> | undefined, length: number];

function refuseGone(): never {
  return refuse('sightline: an array is detached: shrunk, transferred, or from before the memory grew; fetch it from its Block anew', 'detached');
}

/** How many numbers there are; refuses an array that has none because its buffer is gone, or no longer reaches to it. */
export function lengthOf(input: Input<Numbers>): number {
  if (Block.is(input)) return input.length;
  const length = truly(input, 'length');
  if (length > 0) return length;
  try {
    Reflect.apply(typedArray.keys, input, []);
  } catch {
    refuseGone(); // no such array has keys
  }
  return 0;
}

/** The arrays of one call: placed in the module's memory for as long as it runs. */
export class Call {
  readonly #borrowed: number[] = [];

  /** Pointers to the arrays, in order; 0 for none. Refuses what is shorter now than when it was counted. */
  place(...inputs: Sized[]): number[] {
    const found = inputs.map(([input, length]) => (input === undefined ? 0 : where(input, length)));
    return found.map((pointer, i) => (pointer === undefined ? this.#copy(inputs[i]![0] as Numbers) : pointer));
  }
  /** Room of its own. */
  room(byteLength: number): number {
    const pointer = allocate(byteLength);
    if (pointer === 0) refuse(`sightline: no memory for ${byteLength} bytes`, 'too_many');
    this.#borrowed.push(pointer);
    return pointer;
  }
  end(): void {
    for (const pointer of this.#borrowed) wasm().release!(pointer);
  }

  #copy(array: Numbers): number {
    const size = truly(array, 'byteLength'), pointer = this.room(size);
    new Uint8Array(buffer(), pointer, size).set(new Uint8Array(truly(array, 'buffer'), truly(array, 'byteOffset'), size));
    return pointer;
  }
}

// Undefined where it has to be copied.
function where(input: Input<Numbers>, length: number): number | undefined {
  if (Block.is(input)) return input.pointer;
  if (lengthOf(input) < length) refuseGone();
  return truly(input, 'buffer') === buffer() ? truly(input, 'byteOffset') : undefined;
}

/** Runs a call with arrays of its own. */
export function calling<R>(body: (call: Call) => R): R {
  const call = new Call();
  try {
    return body(call);
  } finally {
    call.end();
  }
}

/** Throws unless it is an array of that kind. */
export function expectKind<T extends Numbers>(what: string, input: unknown, kind: Kind<T>): asserts input is Input<T> {
  if (Block.is(input) ? (input.kind as unknown) === kind : ArrayBuffer.isView(input) && input instanceof kind) return;
  refuse(`${what}: expected a ${(kind as unknown as { name: string }).name} or a Block of one`);
}

/** How many elements of so many numbers each an array of that kind has. */
export function countOf<T extends Numbers>(what: string, name: string, input: Input<T>, kind: Kind<T>, numbers: number, code?: Code): number {
  expectKind(`${what}: ${name}`, input, kind);
  const length = lengthOf(input);
  if (length % numbers !== 0) refuse(`${what}: ${length} numbers of ${name}, expected a multiple of ${numbers}`, code);
  return length / numbers;
}

/** Throws unless it is a Block of that kind, for what a call writes. */
export function expectBlock<T extends Numbers>(what: string, out: unknown, kind: Kind<T>): asserts out is Block<T> {
  if (!(Block.is(out) && (out.kind as unknown) === kind))
    refuse(`${what}: expected a Block of a ${(kind as unknown as { name: string }).name}`);
}

/** Reads what a call was given; where that cannot be read, as with a Proxy of a typed array, it is refused. */
export function reading<R>(what: string, read: () => R, code?: Code): R {
  try {
    return read();
  } catch (error) {
    if (!(error instanceof TypeError || error instanceof RangeError)) throw error;
    return refuse(`${what}: cannot be read (${error.message}), expected plain objects and arrays`, code);
  }
}

/** What stands under some names, each read once. */
export const fields = <T extends object, K extends (keyof T)[]>(what: string, given: T | null | undefined, names: [...K], code?: Code) =>
  reading(what, () => names.map((name) => given?.[name]), code) as { [I in keyof K]: T[K[I]] | undefined };

/** Throws at another name, as what is misspelt would do nothing, and at what is no plain object. */
export function expectNames(what: string, given: object, names: readonly string[]): void {
  reading(what, () => {
    const plain = typeof given === 'object' && !Array.isArray(given) && !ArrayBuffer.isView(given);
    const other = plain ? Object.keys(given).find((name) => !names.includes(name)) : said(given);
    if (other !== undefined) refuse(`${what}: ${other} is no option, expected an object of ${names.join(', ')}`);
  });
}

/** Options under these names and no others, each read once. Null is none. */
export function readOptions<T extends object, K extends (keyof T & string)[]>(what: string, given: T | null | undefined, names: [...K]) {
  if (given != null) expectNames(what, given, names);
  return fields(what, given, names);
}

/** instanceof, which throws for a Proxy that was revoked. */
export function isA<T>(given: unknown, kind: abstract new (...all: never[]) => T): given is T {
  try {
    return given instanceof kind;
  } catch {
    return false;
  }
}

/** A copy of so many numbers, `name` in refusals. Reading them may run code of the caller's, which may move the module's memory
 * or dispose of what lies there: so they are read first, and written from the copy. */
export function readNumbers(what: string, name: string, given: ArrayLike<number> | undefined, count: number, code?: Code): number[] {
  return reading(what, () => {
    if (given?.length !== count) refuse(`${what}: ${name} of ${said(given?.length)} numbers, expected ${count}`, code);
    const read = Array.from({ length: count }, (_, i) => given[i]!);
    for (const number of read)
      if (typeof number !== 'number') refuse(`${what}: ${name} of ${said(number)}, expected ${count} numbers`, code);
    return read;
  }, code);
}
export const readOrigin = (what: string, origin: ArrayLike<number>, code?: Code): number[] =>
  readNumbers(what, 'an origin', origin, 3, code);

/** Throws unless it is an array of that kind with so many elements. */
export function expectColumn<T extends Numbers>(what: string, input: Input<T>, kind: Kind<T>, length: number): void {
  expectKind(what, input, kind);
  expectLength(what, input, length);
}

/** Throws unless it has so many elements. */
export function expectLength(what: string, input: Input<Numbers>, length: number): void {
  const own = lengthOf(input);
  if (own !== length) refuse(`${what}: ${own} elements, expected ${length}`);
}
