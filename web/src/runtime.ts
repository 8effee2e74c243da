// The one WebAssembly instance of a program: where it comes from, and how it is called.
import { codes, refuse, refuseProxy, said, SightlineError } from './errors.js';

/** What the module exports; pointers and counts are numbers. */
type Exports = Record<string, (...args: number[]) => number>;
/** Bytes of a module, or whatever fetches them. */
export type Source = BufferSource | WebAssembly.Module | Response | Promise<Response | BufferSource | WebAssembly.Module>;

// A function of one SIMD instruction.
const simd = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);

/** Whether this browser runs the module: WebAssembly with SIMD, which all have since 2023. */
export const supported: boolean = typeof WebAssembly === 'object' && WebAssembly.validate(simd);

const unsupported =
  'sightline: this browser has no WebAssembly with SIMD, expected one of 2023 or later; draw without culling';

let exports: Exports | undefined;
let memory: WebAssembly.Memory;
let offered: { rank: number; inflate: () => Promise<BufferSource> } | undefined;
let loading: Promise<void> | undefined;

async function compile(source: Source): Promise<WebAssembly.Module> {
  const given = await source;
  if (given instanceof WebAssembly.Module) return given;
  // Asked last, as Node takes as long to load Response as all the rest takes.
  const bytes = given instanceof ArrayBuffer || ArrayBuffer.isView(given);
  if (!bytes && typeof Response !== 'undefined' && given instanceof Response) {
    if (!given.ok) refuse(`sightline: ${given.url || 'the module'} could not be fetched (${given.status})`);
    return WebAssembly.compile(await given.arrayBuffer());
  }
  if (!bytes) refuse(`initialise: ${said(given)}, expected bytes, a WebAssembly.Module or a Response`);
  return WebAssembly.compile(given as BufferSource);
}

async function instanceOf(source: Source): Promise<WebAssembly.Instance> {
  try {
    return await WebAssembly.instantiate(await compile(source), {});
  } catch (error) {
    if (error instanceof SightlineError) throw error;
    return refuse(`sightline: the module could not be loaded (${(error as Error)?.message}); try again`);
  }
}

async function start(source: Source): Promise<void> {
  if (!supported) refuse(unsupported, 'unsupported');
  const { memory: own, _initialize, ...functions } = (await instanceOf(source)).exports as unknown as Exports & {
    memory: WebAssembly.Memory;
  };
  if (!(own instanceof WebAssembly.Memory && functions.world_create))
    refuse('initialise: another module, expected whole.wasm or core.wasm');
  _initialize?.();
  memory = own;
  exports = Object.fromEntries(Object.entries(functions).map(([name, call]) => [name, guarded(call)]));
}

// The library does not come back from running out of memory.
function guarded(call: (...args: number[]) => number): (...args: number[]) => number {
  return (...args) => {
    try {
      return call(...args);
    } catch (error) {
      if (!(error instanceof WebAssembly.RuntimeError)) throw error;
      const ended = () =>
        refuse('sightline: the module has ended, most likely out of memory; load the page anew', 'ended');
      exports = new Proxy({}, { get: () => ended });
      return ended();
    }
  };
}

/** Starts the module from bytes of your own, instead of those that `sightline-culling` and `/core` bring along. Once; where that
 * failed, as a fetch may, call it again: `ready` is another promise then. */
export function initialise(source: Source): Promise<void> {
  if (loading) refuse('initialise: the module is loaded already, expected one call');
  renew();
  return load(start(source));
}

let settle: (loaded: Promise<void>) => void;
let failed = false;
function promise(): Promise<void> {
  const made = new Promise<void>((resolve) => (settle = resolve));
  made.catch(() => {}); // who does not ask is told by the first call
  return made;
}
/** Resolves when everything can be called; rejects where the module could not be loaded. */
export let ready: Promise<void> = promise();

// For another try.
function renew(): void {
  if (failed) failed = false, (ready = promise());
}

function load(started: Promise<void>): Promise<void> {
  // Before anybody is told: who is may try again at once.
  settle((loading = started.catch((error) => {
    loading = undefined, (failed = true);
    throw error;
  })));
  return ready;
}

/** Whether everything can be called. */
export const isLoaded = (): boolean => exports !== undefined;

/** An entry's own bytes. Of several entries that a program imports, the one that can most is loaded. */
export function offer(rank: number, inflate: () => Promise<BufferSource>): void {
  renew();
  if (!offered || rank > offered.rank) offered = { rank, inflate };
  queueMicrotask(() =>
    setTimeout(() => {
      if (!loading && !failed) void load(start(supported ? offered!.inflate() : new ArrayBuffer(0)));
    }, 0),
  );
}

/** gzip in base64, as the entries carry them. */
export async function inflate(base64: string): Promise<BufferSource> {
  const letters = atob(base64), packed = new Uint8Array(letters.length);
  for (let i = 0; i < packed.length; ++i) packed[i] = letters.charCodeAt(i); // Uint8Array.from takes five times as long
  // Without Blob and Response: see compile().
  const { writable, readable } = new DecompressionStream('gzip'), writer = writable.getWriter(), reader = readable.getReader();
  void writer.write(packed), void writer.close();
  // gzip ends with how many bytes it unpacks to.
  const whole = new Uint8Array(new DataView(packed.buffer).getUint32(packed.length - 4, true));
  let at = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    whole.set(part.value, at);
    at += part.value.length;
  }
  return whole;
}

/** The module's functions. */
export function wasm(): Exports {
  if (!exports) {
    if (!supported) refuse(unsupported, 'unsupported');
    refuse('sightline: not loaded yet, expected `await ready` before the first call', 'not_ready');
  }
  return exports;
}

export function buffer(): ArrayBuffer {
  wasm();
  return memory.buffer as ArrayBuffer;
}

/** Throws what the library said, where it refused. */
export function check(code: number): void {
  if (code === 0) return;
  const { message, refused_index } = wasm();
  const at = message!();
  const bytes = new Uint8Array(memory.buffer);
  const sentence = new TextDecoder().decode(bytes.slice(at, bytes.indexOf(0, at)));
  const index = refused_index!();
  throw new SightlineError(codes[code]!, index < 0 ? sentence : `${sentence} (index ${index})`, index < 0 ? undefined : index);
}

/** What stands in the module and has to be given back. */
export abstract class Owned {
  #pointer: number;
  readonly #destroy: string;
  /** @internal */
  declare readonly what: string;
  /** `what` names it in refusals: a class's own name is another in a bundle that was minified. */
  constructor(what: string, create: string, destroy: string, pointer = need(create)()) {
    Object.defineProperty(this, 'what', { value: what }); // never another: see at()
    this.#pointer = pointer;
    this.#destroy = destroy;
  }
  /** @internal Where it stands in the module, 0 once it was disposed of; refuses what is none, or another kind's. */
  static at(it: Owned, what: string | undefined = it?.what): number {
    if (!(#pointer in Object(it)) || it.what !== what) refuseProxy(what ?? 'sightline');
    return it.#pointer;
  }
  /** @internal */
  get pointer(): number {
    return pointerOf(this.what, this);
  }
  /** Whether dispose() was called. */
  get disposed(): boolean {
    return Owned.at(this) === 0;
  }
  /** Gives its memory back; using it afterwards throws. Doing so twice is nothing. */
  dispose(): void {
    if (Owned.at(this) === 0) return;
    need(this.#destroy)(this.#pointer);
    this.#pointer = 0;
  }
}

/** The pointer of what a method was called on: anything, where the method was taken off its object. Whatever a call's arguments do
 * when they are read has to be done by then. */
export const pointerOf = (what: string, it: Owned): number =>
  Owned.at(it, what) || refuse(`${what}: used after dispose()`, 'disposed');

/** A function that only the whole module has. */
export function need(name: string): (...args: number[]) => number {
  return wasm()[name] ?? refuse(`sightline: the module \`core\` has no ${name}, expected the whole one`, 'unsupported');
}
