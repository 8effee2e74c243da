// `sightline-culling/three`: one line that makes three.js draw only what can be seen, and one that takes it away again.
//
//   const culler = new SightlineCuller(scene, { occlusion: true });
//
// While a scene is rendered its `children` are a shorter list, of what the camera may see; before and after they are what
// they were. What the culler does not know (sprites, lines, skinned meshes, LODs, meshes with children, frustumCulled =
// false) stands in the list as before.
import { BatchedMesh } from 'three';
import type { ArrayCamera, BufferGeometry, Camera, Frustum, InstancedMesh, Material, Object3D, Scene } from 'three';
import { refuse, said } from '../errors.js';
import '../index.js';
import { floats, reading, readOptions } from '../memory.js';
import { OcclusionBuffer } from '../occlusion.js';
import { buffer as memory, isLoaded, ready, supported } from '../runtime.js';
import { Culler, type CullView } from '../world.js';
import { forgetConvex } from './convex.js';
import { eyeOf, isRigid } from './eye.js';
import { Hooks } from './hooks.js';
import { Inventory } from './inventory.js';
import { carrierOf, fill, narrow, type Narrowing, type Range } from './instances.js';
import { breaksDepth, breaksLateDepth, canBeHidden, drawOccluders, type Eye } from './occluders.js';
import { release } from './release.js';
import { restore } from './restore.js';
import type { Sender } from './sending.js';
import { callsBack, countsInstances } from './shaders.js';
import { isSameView, viewOf, viewsOf, type ShadowLight } from './shadows.js';
import { isCalled, isCalledWhenDrawn, isDisplaced, type Thing } from './things.js';
import { Whole } from './whole.js';

export { ready, supported };

export interface SightlineOptions {
  /** Drops what is hidden behind others, too; true. */
  occlusion?: boolean;
  /** Pixels of the occlusion buffer's width; 512. It need not be the canvas's. */
  bufferWidth?: number;
}

/** What the last render() did. */
export interface SightlineStats {
  /** Meshes and instances that can be culled, and of those what the camera may see. */
  objects: number;
  drawn: number;
  /** Objects in view that occlusion dropped, and occluders drawn for it. */
  hidden: number;
  occluders: number;
}

interface Renderer {
  isWebGLRenderer?: boolean;
  sortObjects: boolean;
  clippingPlanes?: readonly unknown[];
  shadowMap?: { enabled: boolean; autoUpdate: boolean; needsUpdate: boolean };
}

/** What three walks, and which of instances it draws. */
interface Pass { ranges: Map<Thing, Range>; list: Object3D[] }
interface Shadow { light: ShadowLight; view: Eye; pass: Pass }
interface Frame { children: Object3D[]; restore: (() => void)[]; narrowed: Narrowing[]; list: Object3D[]; stats?: SightlineStats }

const mostViews = 8;
const restFrames = 16;
/** What so few objects in view hide says nothing of the next frames. */
const fewest = 64;
/** Pixels of the occlusion buffer that an occluder covers at least. */
const leastArea = 100;
/** Scenes that have a culler. */
const taken = new WeakSet<Scene>();

export class SightlineCuller {
  /** Whether it culls; the scene is drawn as three draws it while it does not. */
  enabled = true;
  /** Whether it drops what is hidden behind others. */
  occlusion: boolean;
  /** Culls for this camera instead of the one that draws: to look from elsewhere at what a view keeps. */
  camera: Camera | undefined;
  readonly stats: SightlineStats = { objects: 0, drawn: 0, hidden: 0, occluders: 0 };

  readonly #scene: Scene;
  readonly #bufferWidth: number;
  readonly #frames: Frame[] = [];
  readonly #hooks: Hooks;
  #inside: { inventory: Inventory; culler: Culler; buffer: OcclusionBuffer } | undefined;
  #tried = false;
  #drawn: Eye | undefined;
  #drawing: Camera | undefined;
  readonly #whole = new Whole();
  #rest = 0;
  #left = new Uint32Array(0);
  #told = false;
  #toldOfCamera = false;

  constructor(scene: Scene, options?: SightlineOptions) {
    if (!reading('SightlineCuller', () => scene?.isScene)) refuse('SightlineCuller: expected a Scene');
    const [occlusion = true, bufferWidth = 512] = readOptions('SightlineCuller', options, ['occlusion', 'bufferWidth']);
    if (typeof occlusion !== 'boolean') refuse(`SightlineCuller: an occlusion of ${said(occlusion)}, expected true or false`);
    if (!Number.isInteger(bufferWidth) || bufferWidth < 16 || bufferWidth > 4096)
      refuse(`SightlineCuller: a bufferWidth of ${said(bufferWidth)}, expected an integer from 16 to 4096`);
    if (taken.has(scene)) refuse('SightlineCuller: the scene has one already, expected dispose() of that first');
    taken.add(scene);
    this.#scene = scene;
    this.occlusion = occlusion;
    this.#bufferWidth = bufferWidth;
    this.#hooks = new Hooks(scene, {
      before: (renderer, camera) => this.#begin(renderer as Renderer, camera),
      after: () => this.#end(),
      whole: () => this.#frames.at(-1)?.children,
    });
    ready.catch((error: Error) => this.#tell(error));
  }

  /** The occluders' depth that the last render() drew: 1 / distance along the view at each pixel, -Infinity for none, row by row
   * from the top. For looking at; undefined where none was drawn. */
  readDepth(): { width: number; height: number; nearness: Float32Array } | undefined {
    if (!this.#drawn || !this.#inside) return undefined;
    const { width, height } = this.#drawn, out = floats(width * height);
    try {
      this.#inside.buffer.readNearness(out);
      return { width, height, nearness: out.array.slice() };
    } finally {
      out.dispose();
    }
  }

  /** Takes the culler out of the scene, which is drawn as before. */
  dispose(): void {
    if (this.#hooks.disposed) return;
    while (this.#frames.length > 0) this.#end();
    this.#hooks.dispose();
    taken.delete(this.#scene);
    this.enabled = false;
    for (const { mesh } of this.#inside?.inventory.things ?? [])
      for (const shape of [mesh.geometry, mesh.userData?.occluder]) forgetConvex(shape as BufferGeometry);
    release(...Object.values(this.#inside ?? {}));
    this.#inside = undefined;
  }

  // Tried once: what one module lacks, it lacks in every frame. The buffer first, which the smaller module lacks, so that
  // nothing else is made then.
  #make(): void {
    this.#tried = true;
    const buffer = new OcclusionBuffer(), culler = new Culler();
    this.#inside = { inventory: new Inventory(this.#scene, (error) => this.#tell(error)), culler, buffer };
  }

  // What cannot be culled is drawn whole, and said once.
  #tell(error: Error): void {
    if (!this.#told) console.warn(`Sightline draws without culling: ${error.message}`);
    this.#told = true;
  }

  #try(does: () => void): void {
    try {
      does();
    } catch (error) {
      this.#tell(error as Error);
    }
  }

  #begin(renderer: Renderer, camera: Camera): void {
    const outer = this.#frames.at(-1);
    if (outer) this.#leave(outer); // of a render within a render
    const { children } = this.#scene, frame: Frame = { children, restore: [], narrowed: [], list: children };
    this.#frames.push(frame);
    // compileAsync() begins and never ends; nor does any render where somebody has put another onAfterRender over ours.
    if (!outer) queueMicrotask(() => { while (this.#frames.includes(frame)) this.#end(); });
    if (!this.#tried && isLoaded()) this.#try(() => this.#make());
    this.#inside?.inventory.takeNote();
    const override = this.#scene.overrideMaterial as Material | null;
    // By a material that displaces, all may be elsewhere, and one with a callback counts what is drawn.
    if (this.enabled && this.#inside && renderer.sortObjects && !isDisplaced(override) && !callsBack(override)) {
      this.#drawing = camera;
      this.#try(() => this.#cull(renderer, this.#cameraOr(camera), frame, outer !== undefined));
    }
    this.#shadowed ||= shadowsOf(renderer);
    if (frame.list === children) frame.list = this.#carried(renderer, children, this.#inside?.inventory.many ?? []);
    this.#scene.children = frame.list;
  }
  #shadowed = false; // ever

  // With what has three send the instances of things.
  #carried(renderer: Renderer, list: Object3D[], things: Iterable<Thing>): Object3D[] {
    if (!this.#shadowed || !renderer.isWebGLRenderer) return list;
    const carriers = Array.from(things, ({ mesh, kind }) => kind === 'instanced' && carrierOf(mesh as InstancedMesh)).filter(Boolean);
    return carriers.length > 0 ? [...list, ...carriers as InstancedMesh[]] : list;
  }

  // The one that is set, or the one that draws.
  #cameraOr(drawing: Camera): Camera {
    const { camera } = this;
    if (camera == null || camera.isCamera) return camera ?? drawing;
    if (!this.#toldOfCamera) console.warn(`Sightline culls for the camera that draws: culler.camera is ${said(camera)}, expected a Camera`);
    this.#toldOfCamera = true;
    return drawing;
  }

  #end(): void {
    const frame = this.#frames.pop();
    if (!frame) return;
    for (const undo of frame.restore) undo();
    for (const each of frame.narrowed) each.undo();
    this.#scene.children = frame.children;
    this.#outer();
  }
  // What the render around one takes away of its own, and has back after it.
  #leave(outer: Frame): void {
    this.#scene.children = outer.children, (outer.stats = { ...this.stats });
    for (const each of outer.narrowed) each.undo();
  }
  #outer(): void {
    const outer = this.#frames.at(-1);
    if (!outer) return;
    this.#scene.children = outer.list, Object.assign(this.stats, outer.stats);
    for (const each of outer.narrowed) each.apply();
  }
  #cull(renderer: Renderer, camera: Camera, frame: Frame, nested: boolean): void {
    const { inventory } = this.#inside!;
    const isAlone = !(camera as ArrayCamera).isArrayCamera && !shadowsOf(renderer);
    if (isAlone && this.#whole.standsStill(camera, this.occlusion)) return this.#count(inventory.size);
    const cameras = (camera as ArrayCamera).isArrayCamera ? (camera as ArrayCamera).cameras : [camera];
    if (cameras.length === 0 || cameras.length > mostViews) return;
    const eyes = cameras.map((each) => eyeOf(each, this.#bufferWidth));
    if (this.#whole.stands(() => allViews(eyes, this.#shadowViews(renderer)), this.occlusion)) return this.#count(inventory.size);
    inventory.update();
    inventory.measure(this.#drawing!.layers);
    if (inventory.size === 0) return this.#count(0);
    const lights = this.#shadowViews(renderer);
    const seen = this.#seen(eyes, camera, !renderer.clippingPlanes?.length);
    const inLights = lights.map(({ view }) => this.#inView(view));
    this.#whole.look(inventory, eyes[0]!, this.occlusion, [seen, ...inLights]);
    const main = this.#pass(seen);
    const shadows = lights.map((each, i): Shadow => ({ ...each, pass: this.#pass(inLights[i]!) }));
    this.#swapForShadows(shadows, frame);
    for (const thing of new Set([main, ...shadows.map(({ pass }) => pass)].flatMap(({ ranges }) => [...ranges.keys()])))
      this.#narrow(thing, main, shadows, renderer, frame, nested);
    frame.list = this.#carried(renderer, main.list, main.ranges.keys());
    Object.assign(this.stats, { objects: inventory.size, drawn: seen.length });
  }
  #count(drawn: number): void {
    this.#drawn = undefined;
    const { stats } = this;
    stats.objects = stats.drawn = drawn, (stats.hidden = stats.occluders = 0);
  }

  // Slots that some of the eyes may see, ascending.
  #seen(eyes: readonly Eye[], camera: Camera, whole: boolean): Uint32Array {
    this.#count(0);
    const [eye] = eyes as [Eye], { inventory: { world, slots } } = this.#inside!;
    if (this.occlusion && whole && eyes.length === 1 && isRigid(eye)) {
      if (this.#rest > 0) --this.#rest;
      else if (this.#drawOccluders(eye, camera)) return this.#notHidden(eye);
    }
    const { count, ids } = this.#inside!.culler.cullSorted(world, eyes, slots);
    return new Uint32Array(memory(), ids, count).slice();
  }
  // Draws the occluders among what looks large; whether there were any.
  #drawOccluders(eye: Eye, camera: Camera): boolean {
    const { inventory, culler, buffer } = this.#inside!;
    const large = culler.cull(inventory.world, { ...eye, minArea: leastArea }, { valuesForIds: true }).ids.slice().sort();
    buffer.begin(eye, { coverage: 'area' });
    this.#drawn = eye;
    const override = this.#scene.overrideMaterial as Material | null;
    this.stats.occluders = drawOccluders(buffer, inventory, eye, camera, override, large);
    return this.stats.occluders > 0;
  }
  #notHidden(eye: Eye): Uint32Array {
    const { inventory, culler, buffer } = this.#inside!, override = this.#scene.overrideMaterial as Material | null;
    const { count, ids, masks } = culler.cullSorted(inventory.world, [eye, { ...eye, occlusion: buffer }], inventory.slots);
    const inView = new Uint32Array(memory(), ids, count), maskOf = new Uint8Array(memory(), masks, count);
    const many = Array.from(inventory.many, ({ mesh }) => mesh).filter(isCalledWhenDrawn);
    const called = [...inventory.left.map(({ object }) => object), ...many];
    if (called.some((each) => breaksDepth(each, override))) return inView.slice();
    const isLateBroken = called.some(breaksLateDepth);
    if (this.#left.length < count) this.#left = new Uint32Array(2 * count);
    const left = this.#left;
    let kept = 0, sound = true;
    inventory.forEachShown(inView, ({ mesh }, from, to) => {
      const all = !canBeHidden(mesh, override, isLateBroken);
      if (all && breaksDepth(mesh, override)) sound = false;
      for (let i = from; i < to; ++i) if (all || maskOf[i]! & 2) left[kept++] = inView[i]!;
    });
    if (!sound) return inView.slice();
    this.stats.hidden = count - kept;
    // Where next to nothing is hidden, it is not worth asking every frame.
    if (count > fewest && this.stats.hidden < count / 32) this.#rest = restFrames;
    return left.slice(0, kept);
  }

  #inView(view: CullView): Uint32Array {
    const { inventory, culler } = this.#inside!;
    const { count, ids } = culler.cullSorted(inventory.world, [view], inventory.slots);
    return new Uint32Array(memory(), ids, count).slice();
  }

  // What three is to walk for a view.
  #pass(slots: Uint32Array): Pass {
    const { inventory } = this.#inside!;
    const ranges = new Map<Thing, Range>(), list: Object3D[] = [];
    for (const { object, parent } of inventory.left) if (inventory.nodes[parent]!.shown) list.push(object);
    inventory.forEachShown(slots, (thing, from, to) => {
      if (thing.kind !== 'mesh') ranges.set(thing, { slots, from, to });
      list.push(thing.mesh);
    });
    // Called as three calls them, which culls by spheres, that reach farther than boxes.
    for (const thing of inventory.many)
      if (!ranges.has(thing) && isCalled(thing.mesh) && inventory.nodes[thing.parent]!.shown) list.push(thing.mesh);
    return { ranges, list };
  }

  // Every light's views of this frame.
  #shadowViews(renderer: Renderer): { light: ShadowLight; view: Eye }[] {
    if (!renderer.isWebGLRenderer || !shadowsOf(renderer)) return [];
    const views: { light: ShadowLight; view: Eye }[] = [];
    for (const { object } of this.#inside!.inventory.left) {
      object.traverseVisible((each) => {
        const light = each as ShadowLight, { shadow } = light;
        if (!light.isLight || !light.castShadow || !shadow || !(shadow.autoUpdate || shadow.needsUpdate)) return;
        for (const view of viewsOf(light, this.#drawing!)) views.push({ light, view });
      });
    }
    return views;
  }

  // three asks a light for its frustum just before it walks the scene for it. A view that nobody has foreseen is of the whole.
  #swapForShadows(shadows: Shadow[], frame: Frame): void {
    for (const light of new Set(shadows.map(({ light }) => light))) {
      const { shadow } = light, own = Object.getOwnPropertyDescriptor(shadow, 'getFrustum'), { getFrustum } = shadow;
      shadow.getFrustum = ((viewport?: number) => {
        const view = viewOf(light, viewport), now = shadows.find((each) => each.light === light && isSameView(each.view, view));
        this.#scene.children = now?.pass.list ?? frame.children, (this.#shadow = now?.pass);
        return (getFrustum as (viewport?: number) => Frustum).call(shadow, viewport);
      }) as never;
      frame.restore.push(() => restore(shadow, 'getFrustum', own));
    }
  }
  #shadow: Pass | undefined;

  #narrow(thing: Thing, main: Pass, shadows: Shadow[], renderer: Renderer, frame: Frame, nested: boolean): void {
    const { mesh, kind } = thing;
    if (kind === 'batched') this.#narrowBatch(thing, main, frame);
    if (kind !== 'instanced' || nested || !renderer.isWebGLRenderer) return;
    const instanced = mesh as InstancedMesh;
    if (countsInstances(this.#scene.overrideMaterial as Material | null)) return;
    // Where three does not look at it either, it has no sphere yet, and must not get that of a few of its instances.
    if (!instanced.visible || !instanced.layers.test(this.#drawing!.layers)) return;
    const most = instanced.count >> 1; // half of them copied would cost more than the other half drawn
    const list = instancesOf(thing, main, shadows, most);
    if (list.length === 0 || list.length > most) return;
    const range = main.ranges.get(thing), narrowing = narrow(instanced, list, range ? range.to - range.from : 0);
    frame.narrowed.push(narrowing), narrowing.apply();
  }

  // What somebody else has put there stays, a method of a class of theirs, too, and the batch is drawn whole.
  #narrowBatch(thing: Thing, main: Pass, frame: Frame): void {
    const mesh = thing.mesh as BatchedMesh, own = Object.getOwnPropertyDescriptor(mesh, 'onBeforeRender');
    if (own ? !this.#fills.has(own.value as object) : mesh.onBeforeRender !== listing) return;
    const fills: BatchedMesh['onBeforeRender'] = (by, scene, camera, geometry, material, group) => {
      const pass = scene === null ? this.#shadow : main;
      // Not of a render within this one that culls nothing, nor of a light's view that nobody has foreseen; nor as a wireframe, of
      // which three lists twice as much since 0.183.
      if (this.#frames.at(-1) === frame && pass && !(material as { wireframe?: boolean }).wireframe)
        return fill(thing, pass.ranges.get(thing), by as Sender, camera, geometry, material);
      thing.sending!.end(), listing.call(mesh, by, scene, camera, geometry, material, group);
    };
    this.#fills.add(fills), (mesh.onBeforeRender = fills);
    frame.restore.push(() => (thing.sending!.end(), restore(mesh, 'onBeforeRender', own)));
  }
  readonly #fills = new WeakSet<object>();
}

/** three's own, which lists what of a batch is drawn. */
const listing = BatchedMesh.prototype.onBeforeRender;

// Those that the camera sees, then those that only lights see; none where they are more than `most`.
function instancesOf(thing: Thing, main: Pass, shadows: Shadow[], most: number): Uint32Array {
  const seen = new Set<number>();
  for (const { ranges } of [main, ...shadows.map(({ pass }) => pass)]) {
    const { slots, from, to } = ranges.get(thing) ?? { slots: [], from: 0, to: 0 };
    if (to - from > most) return new Uint32Array(0);
    for (let k = from; k < to; ++k) seen.add(slots[k]! - thing.first);
  }
  return Uint32Array.from(seen);
}

const allViews = (eyes: readonly Eye[], lights: readonly { view: Eye }[]): Eye[] => [...eyes, ...lights.map(({ view }) => view)];
const shadowsOf = ({ shadowMap }: Renderer): boolean =>
  shadowMap !== undefined && shadowMap.enabled && (shadowMap.autoUpdate || shadowMap.needsUpdate);
