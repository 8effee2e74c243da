// `sightline-culling/worker`: a world on another thread, which culls the next frame while this one is drawn. No shared
// memory, so no special headers; what is seen is copied once a frame.
import type { Boxes } from './boxes.js';
import { refuse, refuseProxy, SightlineError, type Code } from './errors.js';
import type { View } from './views.js';
import type { CullOptions } from './world.js';

/** Boxes to post: typed arrays, not Blocks. */
export type PostedBoxes = Exclude<Boxes, { pointer: number }>;
/** A view without occlusion. */
export interface PostedView extends View {
  layers?: number;
  minArea?: number;
}
/** What was seen, in arrays of your own. */
export interface PostedCull {
  ids: Uint32Array;
  masks: Uint8Array;
  tested: number;
  nodesVisited: number;
}

/** @internal What goes there and comes back. */
export interface Request { id: number; name: string; args: unknown[] }
/** @internal */
export interface Reply { id: number; value?: unknown; error?: { code: Code; message: string; index: number | undefined } }

/** A thread as both browsers and Node make them. */
interface Thread {
  postMessage(message: unknown): void;
  terminate(): unknown;
  onmessage?: ((event: { data: Reply }) => void) | null;
  onerror?: ((event: { message?: string; preventDefault?(): void }) => void) | null;
  on?(name: string, listener: (value: never) => void): void;
}

/** A World and its Culler on a thread of their own; calls are done in the order they were made. */
export class WorkerWorld {
  readonly #thread: Thread;
  readonly #waiting = new Map<number, { resolve: (value: never) => void; reject: (error: Error) => void }>();
  #next = 0;
  #ended: SightlineError | undefined; // what calls are refused with from then on

  private constructor(thread: Thread) {
    if (typeof thread?.postMessage !== 'function') refuse('WorkerWorld: made by `new`, expected `await WorkerWorld.start()`');
    this.#thread = thread;
    const settle = (reply: Reply): void => {
      const waiting = this.#waiting.get(reply.id);
      this.#waiting.delete(reply.id);
      if (reply.error) waiting?.reject(new SightlineError(reply.error.code, reply.error.message, reply.error.index));
      else waiting?.resolve(reply.value as never);
    };
    const fail = (error?: { message?: string }): void => this.#end(new SightlineError('ended',
      `WorkerWorld: its thread has ended, is worker-thread.js beside worker.js? (${error?.message ?? 'it could not be loaded'})`));
    if (thread.on) {
      thread.on('message', settle as (value: never) => void);
      thread.on('error', fail as (value: never) => void);
    } else {
      thread.onmessage = (event) => settle(event.data);
      thread.onerror = (event) => (event.preventDefault?.(), fail(event));
    }
  }

  /** Starts the thread, and waits until it can be called. */
  static async start(): Promise<WorkerWorld> {
    const made = new WorkerWorld(await thread());
    await WorkerWorld.#post(made, 'ready');
    return made;
  }

  insert(boxes: PostedBoxes, columns: { layers?: Uint32Array; values?: Uint32Array } = {}): Promise<Float64Array> {
    return WorkerWorld.#post(this, 'insert', boxes, columns);
  }
  move(handles: Float64Array, boxes: PostedBoxes): Promise<void> {
    return WorkerWorld.#post(this, 'move', handles, boxes);
  }
  remove(handles: Float64Array): Promise<void> {
    return WorkerWorld.#post(this, 'remove', handles);
  }
  setLayers(handles: Float64Array, layers: Uint32Array): Promise<void> {
    return WorkerWorld.#post(this, 'setLayers', handles, layers);
  }
  setValues(handles: Float64Array, values: Uint32Array): Promise<void> {
    return WorkerWorld.#post(this, 'setValues', handles, values);
  }
  cull(views: PostedView | readonly PostedView[], options: Pick<CullOptions, 'valuesForIds'> = {}): Promise<PostedCull> {
    return WorkerWorld.#post(this, 'cull', views, options);
  }
  /** Ends the thread; calls that still wait are refused. */
  dispose(): void {
    if (!(#ended in Object(this))) refuseProxy('WorkerWorld');
    this.#end(new SightlineError('disposed', 'WorkerWorld: disposed before it answered'));
    this.#ended = new SightlineError('disposed', 'WorkerWorld: used after dispose()');
  }

  // Calls that wait, and all later ones, are refused.
  #end(error: SightlineError): void {
    this.#ended = error;
    this.#thread.terminate();
    for (const { reject } of this.#waiting.values()) reject(error);
    this.#waiting.clear();
  }

  static async #post<R>(to: WorkerWorld, name: string, ...args: unknown[]): Promise<R> {
    if (!(#ended in Object(to))) refuseProxy('WorkerWorld');
    if (to.#ended) throw to.#ended;
    return new Promise<R>((resolve, reject) => {
      const id = to.#next++;
      to.#waiting.set(id, { resolve: resolve as (value: never) => void, reject });
      try {
        to.#thread.postMessage({ id, name, args } satisfies Request);
      } catch (error) { // Blocks and what is detached cannot go there
        to.#waiting.delete(id);
        reject(new SightlineError('bad_argument', `WorkerWorld: ${name} was given what cannot be posted, expected arrays of your own (${(error as Error).message})`));
      }
    });
  }
}

async function thread(): Promise<Thread> {
  if (typeof Worker === 'function')
    return new Worker(new URL('./worker-thread.js', import.meta.url), { type: 'module' }) as unknown as Thread;
  const threads = 'node:worker_threads'; // a name that bundlers for browsers do not look up
  const { Worker: NodeWorker } = (await import(/* @vite-ignore */ threads)) as typeof import('node:worker_threads');
  return new NodeWorker(new URL('./worker-thread.js', import.meta.url)) as unknown as Thread;
}
