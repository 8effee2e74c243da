// What stands in a scene, kept up to date: things with boxes in a World, and what three draws by itself.
import { Object3D } from 'three';
import type { BatchedMesh, InstancedMesh, Layers, Mesh, Scene } from 'three';
import { doubles, type Block } from '../memory.js';
import { World } from '../world.js';
import { measure } from './bounds.js';
import { putNowhere } from './boxes.js';
import { release } from './release.js';
import { Resting } from './resting.js';
import { classify, disposeOf, isOther, isRestless, makeThing, sumOf, takeNote, update, type Known, type Thing } from './things.js';

/** With the list of children that we know, and how many it has. */
interface Node { object: Object3D; parent: number; shown: boolean; children: Object3D[]; count: number }
const nodeOf = (object: Object3D, parent: number): Node =>
  ({ object, parent, shown: true, children: object.children, count: object.children.length });
/** In the place of one that has gone. */
const nobody = new Object3D();
nobody.visible = false;
/** Something that is left to three, with all below it. */
export interface Left { object: Object3D; parent: number }

const atOnce = 32; // things that are looked at together
const fewestFreed = 1024, fewestGone = 256; // slots without a thing, and groups, that are worth making all anew

/** Nodes that only hold others; not those that clip them. */
const isThrough = (object: Object3D): boolean =>
  (object.type === 'Object3D' || object.type === 'Group') && object.renderOrder === 0 &&
  !(object as { isClippingGroup?: boolean }).isClippingGroup;

/** Whether what was left to three is culled, or looked into, as it stands now. */
const isOrdinary = (object: Object3D): boolean => isThrough(object) || classify(object) !== undefined;

// Where the first of ascending slots is that lies at or behind `slot`, from … to.
function firstFrom(slots: Uint32Array, slot: number, from: number, to = slots.length): number {
  while (from < to) {
    const middle = (from + to) >> 1;
    if (slots[middle]! < slot) from = middle + 1;
    else to = middle;
  }
  return from;
}

export class Inventory {
  world = new World();
  /** Minimum and maximum, by slot. */
  boxes: Block<Float64Array> = doubles(6);
  slots = 0;
  /** Meshes and instances that can be culled: those in the world. */
  size = 0;
  /** Whose slot it is. */
  readonly thingOf: (Thing | undefined)[] = [];
  readonly things = new Set<Thing>();
  /** Instanced and batched ones. */
  readonly many = new Set<Thing>();
  left: Left[] = [];
  readonly nodes: Node[] = [];
  readonly #indexOf = new Map<Object3D, number>(); // in nodes
  /** Nobody's; kept so that compilers do not leave out what it sums. */
  sum = 0;

  readonly #scene: Scene;
  readonly #thingOfMesh = new Map<Object3D, Thing>();
  readonly #resting = new Resting();
  readonly #free = new Map<number, number[]>();
  #freed = 0; // slots of what was removed
  #gone = 0; // groups that were
  #handles = new Float64Array(0);
  #matrices = new Float64Array(0);
  #changed = true;
  readonly #moved: number[] = [];
  readonly #tell: (error: Error) => void;
  readonly #added = ({ child, target }: { child: Object3D; target: Object3D }) => this.#hear(() => this.#add(child, target, 1));
  readonly #removed = ({ child, target }: { child: Object3D; target: Object3D }) => this.#hear(() => this.#remove(child, target));

  /** `tell` hears what goes wrong while the scene changes. */
  constructor(scene: Scene, tell: (error: Error) => void) {
    this.#scene = scene, (this.#tell = tell);
  }

  /** To be called in every frame, before three draws, whether it is culled or not. */
  takeNote(): void {
    for (const thing of this.many) if (thing.ranges) takeNote(thing);
  }

  /** Takes over what has moved, come or gone since the last call. */
  update(): void {
    if (!this.#changed) this.#scan();
    // Slots that nobody's count fits would pile up, and places of groups that have gone.
    if (this.#changed || this.#freed > this.size + fewestFreed || 2 * this.#gone > this.nodes.length + fewestGone) this.#rebuild();
    for (const [i, node] of this.nodes.entries()) {
      const { object, parent } = node, { children } = object;
      node.shown = object.visible && (i === 0 || this.nodes[parent]!.shown);
      if (i > 0 && object.renderOrder !== 0) this.#changed = true;
      // Somebody has written there by themselves.
      if (children !== node.children || children.length !== node.count) this.#changed = true;
    }
    if (this.#changed) this.update();
  }

  /** Has things measured that three would measure now: it culls by the sphere that it made when it first looked. */
  measure(layers: Layers): void {
    for (const thing of this.many) {
      const mesh = thing.mesh as InstancedMesh | BatchedMesh;
      if (!mesh.visible || !mesh.layers.test(layers) || !this.nodes[thing.parent]!.shown) continue;
      measure(mesh);
    }
  }

  /** Visits the slots of each thing that is shown, from … to - 1 of ascending ones. */
  forEachShown(slots: Uint32Array, visit: (thing: Thing, from: number, to: number) => void): void {
    for (let from = 0, next; from < slots.length; from = next) {
      const thing = this.thingOf[slots[from]!]!, { kind, first, count, parent } = thing;
      next = kind === 'mesh' ? from + 1 : firstFrom(slots, first + count, from + 1);
      if (!this.nodes[parent]!.shown) continue;
      const to = kind === 'instanced' ? firstFrom(slots, first + (thing.mesh as InstancedMesh).count, from, next) : next;
      if (to > from) visit(thing, from, to);
    }
  }

  dispose(): void {
    for (const { object } of this.nodes) this.#listen(object, false);
    for (const thing of this.things) disposeOf(thing);
    release(this.world, this.boxes);
  }

  #scan(): void {
    const some: Thing[] = [];
    for (const thing of this.things) if (some.push(thing) === atOnce) this.#look(some);
    this.#look(some);
    if (this.left.some((each) => !this.#resting.has(each) && isOrdinary(each.object))) this.#changed = true;
    if (!this.#changed) this.#move();
    this.#moved.length = 0;
    for (const thing of this.many) if (isRestless(thing)) this.#leave(thing);
    for (const left of this.#resting.calm()) {
      this.left.splice(this.left.indexOf(left), 1);
      this.#add(left.object, this.nodes[left.parent]!.object, 0);
    }
  }
  #look(some: Thing[]): void {
    const known = this.#known();
    this.sum = sumOf(some);
    for (const thing of some) {
      if (isOther(thing)) this.#changed = true;
      else this.#update(thing, known);
    }
    some.length = 0;
  }
  #update(thing: Thing, known: Known): void {
    const { live } = thing;
    update(thing, known);
    this.size += thing.live - live;
  }
  #known(): Known {
    return { boxes: this.boxes.array, matrices: this.#matrices, moved: this.#moved };
  }

  // Gives the world what #moved names.
  #move(): void {
    const count = this.#moved.length;
    if (count === 0) return;
    const boxes = this.boxes.array, to = new Float64Array(6 * count), handles = new Float64Array(count);
    for (let i = 0; i < count; ++i) {
      const slot = this.#moved[i]!;
      handles[i] = this.#handles[slot]!;
      for (let k = 0; k < 6; ++k) to[6 * i + k] = boxes[6 * slot + k]!;
    }
    this.world.move(handles, to);
  }

  #rebuild(): void {
    for (const { object } of this.nodes) this.#listen(object, false);
    for (const list of [this.nodes, this.left, this.thingOf]) list.length = 0;
    for (const thing of this.things) disposeOf(thing);
    for (const all of [this.things, this.many, this.#indexOf, this.#thingOfMesh, this.#free, this.#resting]) all.clear();
    this.slots = this.size = this.#freed = this.#gone = 0;
    release(this.world), (this.world = new World());
    const found: Thing[] = [];
    this.#walkBelow(this.#scene, -1, found);
    this.#enter(found);
    this.#changed = false;
  }

  #walk(object: Object3D, parent: number, found: Thing[]): void {
    const taken = classify(object);
    if (taken) return void found.push(this.#thing(object as Mesh, parent, taken.kind, taken.count));
    if (!isThrough(object)) return void this.left.push({ object, parent });
    this.#walkBelow(object, parent, found);
  }
  #walkBelow(object: Object3D, parent: number, found: Thing[]): void {
    const index = this.nodes.push(nodeOf(object, parent)) - 1;
    this.#indexOf.set(object, index);
    this.#listen(object, true);
    for (const child of object.children) this.#walk(child, index, found);
  }

  #thing(mesh: Mesh, parent: number, kind: Thing['kind'], count: number): Thing {
    const first = this.#free.get(count)?.pop() ?? this.slots;
    if (first === this.slots) this.slots += count;
    else this.#freed = Math.max(this.#freed - count, 0);
    const thing = makeThing(mesh, kind, first, count, parent);
    this.things.add(thing);
    if (kind !== 'mesh') this.many.add(thing);
    if (thing.ranges) takeNote(thing);
    this.#thingOfMesh.set(mesh, thing);
    for (let i = 0; i < count; ++i) this.thingOf[first + i] = thing;
    return thing;
  }

  // Puts things into the world.
  #enter(found: Thing[]): void {
    this.#reserve();
    const boxes = this.boxes.array;
    const slots: number[] = [];
    for (const thing of found) {
      putNowhere(boxes, thing.first, thing.first + thing.count);
      this.#matrices.fill(NaN, 12 * thing.first, 12 * thing.first + 12);
      this.size += thing.live;
      this.#update(thing, this.#known());
      for (let i = 0; i < thing.count; ++i) slots.push(thing.first + i);
    }
    this.#moved.length = 0;
    if (slots.length === 0) return;
    const entered = new Float64Array(6 * slots.length), values = Uint32Array.from(slots);
    slots.forEach((slot, i) => entered.set(boxes.subarray(6 * slot, 6 * slot + 6), 6 * i));
    this.world.insert(entered, { values }).forEach((handle, i) => (this.#handles[slots[i]!] = handle));
  }

  #reserve(): void {
    if (6 * this.slots > this.boxes.length) {
      const larger = doubles(12 * this.slots);
      larger.array.set(this.boxes.array);
      this.boxes.dispose();
      this.boxes = larger;
    }
    if (this.slots > this.#handles.length) {
      const larger = new Float64Array(2 * this.slots);
      larger.set(this.#handles);
      this.#handles = larger;
      const matrices = new Float64Array(24 * this.slots);
      matrices.set(this.#matrices);
      this.#matrices = matrices;
    }
  }

  // Within the user's own call, which is to do all that it does without the culler.
  #hear(change: () => void): void {
    try {
      change();
    } catch (error) {
      this.#changed = true, this.#tell(error as Error);
    }
  }

  // What comes or goes is looked into, with all below it.
  #add(child: Object3D, parent: Object3D, more: number): void {
    const index = this.#indexOf.get(parent), found: Thing[] = [];
    if (this.#changed || index === undefined) return void (this.#changed = true);
    this.nodes[index]!.count += more;
    this.#walk(child, index, found);
    this.#enter(found);
  }
  #remove(child: Object3D, parent: Object3D): void {
    const index = this.#indexOf.get(parent), left = new Set<Object3D>();
    if (this.#changed || index === undefined) return void (this.#changed = true);
    --this.nodes[index]!.count;
    this.#removeBelow(child, left);
    if (left.size === 0) return;
    for (const each of this.left) if (left.has(each.object)) this.#resting.delete(each);
    this.left = this.left.filter(({ object }) => !left.has(object));
  }
  // With all below it; names what was left to three.
  #removeBelow(object: Object3D, left: Set<Object3D>): void {
    const thing = this.#thingOfMesh.get(object), index = this.#indexOf.get(object);
    if (thing) return (this.#freed += thing.count), this.#forget(thing);
    if (index === undefined) return void left.add(object);
    const { children } = object, node = this.nodes[index]!;
    if (children !== node.children || children.length !== node.count) this.#changed = true;
    for (const child of children) this.#removeBelow(child, left);
    this.#listen(object, false), this.#indexOf.delete(object);
    this.nodes[index] = nodeOf(nobody, 0), ++this.#gone; // others keep their places
  }
  // Three draws it by itself as long as it is restless.
  #leave(thing: Thing): void {
    this.#forget(thing);
    const left = { object: thing.mesh, parent: thing.parent };
    this.left.push(left), this.#resting.add(left);
  }
  #forget(thing: Thing): void {
    this.world.remove(this.#handles.subarray(thing.first, thing.first + thing.count));
    this.size -= thing.live;
    disposeOf(thing);
    this.things.delete(thing), this.many.delete(thing), this.#thingOfMesh.delete(thing.mesh);
    for (let i = 0; i < thing.count; ++i) this.thingOf[thing.first + i] = undefined;
    const free = this.#free.get(thing.count);
    if (free) free.push(thing.first);
    else this.#free.set(thing.count, [thing.first]);
  }

  #listen(object: Object3D, on: boolean): void {
    const change = on ? 'addEventListener' : 'removeEventListener';
    object[change]('childadded', this.#added as never);
    object[change]('childremoved', this.#removed as never);
  }
}

