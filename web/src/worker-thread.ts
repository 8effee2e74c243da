// The other side of WorkerWorld.
import { SightlineError } from './errors.js';
import { Culler, ready, World } from './core.js';
import type { Reply, Request } from './worker.js';

type Post = (reply: Reply, transfer?: ArrayBuffer[]) => void;
interface Scope { postMessage: Post; onmessage: ((event: { data: Request }) => void) | null }

let world: World, culler: Culler;

function answer(name: string, args: unknown[]): unknown {
  if (name === 'ready') return void ((world ??= new World()), (culler ??= new Culler()));
  if (name !== 'cull') return (world[name as 'insert'] as (...given: unknown[]) => unknown)(...args);
  const [views, options] = args as [Parameters<Culler['cull']>[1], Parameters<Culler['cull']>[2]];
  const { ids, masks, tested, nodesVisited } = culler.cull(world, views, options);
  return { ids: ids.slice(), masks: masks.slice(), tested, nodesVisited };
}

async function handle(request: Request, post: Post): Promise<void> {
  const { id, name, args } = request;
  try {
    await ready;
    const value = answer(name, args);
    const seen = value as { ids?: Uint32Array; masks?: Uint8Array } | undefined;
    post({ id, value }, seen?.ids ? [seen.ids.buffer as ArrayBuffer, seen.masks!.buffer as ArrayBuffer] : []);
  } catch (error) {
    const { code = 'bad_argument', index } = error as Partial<SightlineError>;
    post({ id, error: { code, message: (error as Error).message, index } });
  }
}

const scope = globalThis as unknown as Scope;
if (typeof scope.postMessage === 'function') {
  scope.onmessage = (event) => void handle(event.data, (reply, transfer) => scope.postMessage(reply, transfer));
} else {
  const threads = 'node:worker_threads';
  // Not awaited at the top, which workers as Vite bundles them by default may not.
  void (import(/* @vite-ignore */ threads) as Promise<typeof import('node:worker_threads')>).then(({ parentPort }) =>
    parentPort!.on('message', (request: Request) =>
      void handle(request, (reply, transfer) => parentPort!.postMessage(reply, transfer))));
}
