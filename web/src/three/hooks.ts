// What a culler hangs into a scene: before and after each render; and, as the scene has a shorter list of children
// meanwhile, the methods that change the list.
import type { Camera, Scene } from 'three';
import { restore } from './restore.js';

/** Who is told. */
export interface Told {
  before(renderer: unknown, camera: Camera): void;
  after(): void;
  /** All the children, while another list stands in for them. */
  whole(): Scene['children'] | undefined;
}

type Method = (this: Scene, ...all: unknown[]) => unknown;
const changing = ['add', 'remove', 'attach', 'clear'] as const;

export class Hooks {
  disposed = false;
  readonly #scene: Scene;
  readonly #put: (() => void)[] = [];

  constructor(scene: Scene, told: Told) {
    this.#scene = scene;
    this.#over('onBeforeRender', (own, all) => {
      own.apply(scene, all);
      if (!this.disposed) told.before(all[0], all[2] as Camera);
    });
    this.#over('onAfterRender', (own, all) => {
      if (!this.disposed) told.after();
      own.apply(scene, all);
    });
    // three looks for what it takes out in the list that it finds.
    for (const name of changing)
      this.#over(name, (own, all) => onWhole(scene, told.whole(), () => own.apply(scene, all)));
  }

  /** What somebody else has put over ours stays, and ours below it does nothing more. */
  dispose(): void {
    this.disposed = true;
    for (const takeAway of this.#put.splice(0)) takeAway();
  }

  #over(name: string, call: (own: Method, all: unknown[]) => unknown): void {
    const methods = this.#scene as unknown as Record<string, Method>;
    const before = Object.getOwnPropertyDescriptor(this.#scene, name), own = methods[name]!;
    const ours: Method = (...all) => call(own, all);
    methods[name] = ours;
    this.#put.push(() => methods[name] === ours && restore(this.#scene, name, before));
  }
}

function onWhole<R>(scene: Scene, whole: Scene['children'] | undefined, change: () => R): R {
  if (!whole) return change();
  const { children } = scene;
  scene.children = whole;
  try {
    return change();
  } finally {
    scene.children = children;
  }
}
