// `sightline-culling/three-tiles`: a plug-in for NASA-AMMOS' 3DTilesRendererJS. Tiles behind others are neither refined nor
// loaded nor drawn.
//
//   const plugin = new SightlineTilesPlugin();
//   tiles.registerPlugin(plugin);
//
// What the last update left on the screen is drawn into a depth buffer of the screen's own pixels; a tile whose bounds nobody
// can see through it is masked, as a region of the renderer's own LoadRegionPlugin would mask it.
import type { BufferAttribute, BufferGeometry, Camera, Material, Mesh, Object3D, Scene } from 'three';
import { Box3, Matrix4, Vector3 } from 'three';
import { refuse, said } from './errors.js';
import './index.js';
import { bytes, reading, readOptions, type Block } from './memory.js';
import { OccluderMesh, OcclusionBuffer } from './occlusion.js';
import { isLoaded, ready, supported } from './runtime.js';
import { isInstancedGeometry, isStill, pointsOf, type Points } from './three/bounds.js';
import { eyeOf, isRigid } from './three/eye.js';
import {
  breaksDepth, breaksLateDepth, canBeHidden, determinantOf, isInFrustum, isSkewed, markOf, materialsOf, mayOcclude,
  setFrustum, type Eye,
} from './three/occluders.js';
import { release } from './three/release.js';

export { ready, supported };

export interface SightlineTilesOptions {
  /** Triangles drawn as occluders for each camera, nearest tiles first; 60,000. */
  mostTriangles?: number;
}

/** What the plug-in needs of a tile and of the renderer (0.4.18 to 0.5.3). */
interface Tile {
  engineData: { scene: Object3D | null; boundingVolume: { getAABB(target: Box3): void; distanceToPoint(point: Vector3): number } };
}
interface Tiles {
  group: Object3D & { matrixWorldInverse: Matrix4 };
  cameras: Camera[];
  cameraMap: Map<Camera, { width: number; height: number }>;
  visibleTiles: Set<Tile>;
  addEventListener(name: string, listener: () => void): void;
  removeEventListener(name: string, listener: () => void): void;
}
interface ViewError { inView: boolean; error: number; distance: number }

const isTiles = (tiles: Tiles | undefined): boolean => typeof tiles?.addEventListener === 'function' && Boolean(tiles.group) &&
  Array.isArray(tiles.cameras) && tiles.cameraMap instanceof Map && tiles.visibleTiles instanceof Set;

/** What hides things for one camera. */
interface Sight { buffer: OcclusionBuffer; eye: Eye }

/** A geometry as an occluder, null where it is none, and what it was made of. */
interface Made { mesh: OccluderMesh | null; both: boolean; points: Points; index: BufferAttribute | null; versions: number; forget: () => void }

// What is drawn once, as its geometry stands.
const isPlain = (mesh: Mesh): boolean => isStill(mesh) && !isInstancedGeometry(mesh) &&
  !(mesh as { isInstancedMesh?: boolean }).isInstancedMesh && !(mesh as { isBatchedMesh?: boolean }).isBatchedMesh;

// three cuts off what is below it.
const isClipping = (object: Object3D): boolean => (object as { isClippingGroup?: boolean }).isClippingGroup === true;

export class SightlineTilesPlugin {
  readonly name = 'SIGHTLINE_TILES_PLUGIN';
  /** Whether it masks; without it tiles are as the renderer has them. */
  enabled = true;
  /** What the last update() did. */
  readonly stats = { occluders: 0, triangles: 0, tested: 0, hidden: 0 };

  readonly #mostTriangles: number;
  readonly #meshes = new Map<BufferGeometry, Made>();
  readonly #buffers: OcclusionBuffer[] = [];
  readonly #box = new Box3();
  readonly #numbers = new Float64Array(6);
  #seen: Block<Uint8Array> | undefined;
  #tiles: Tiles | undefined;
  #sights: Sight[] = [];
  #override: Material | null = null;
  #isLateBroken = false;
  #told = false;

  constructor(options?: SightlineTilesOptions) {
    const [mostTriangles = 60_000] = readOptions('SightlineTilesPlugin', options, ['mostTriangles']);
    if (!Number.isInteger(mostTriangles) || mostTriangles < 1)
      refuse(`SightlineTilesPlugin: ${said(mostTriangles)} triangles, expected an integer of 1 or more`);
    this.#mostTriangles = mostTriangles;
    ready.catch((error: Error) => this.#tell(error));
  }

  /** Called by TilesRenderer.registerPlugin(). */
  init(tiles: unknown): void {
    if (!reading('SightlineTilesPlugin', () => isTiles(tiles as Tiles | undefined)))
      refuse('SightlineTilesPlugin: init() without a TilesRenderer, expected registerPlugin() of one to call it');
    this.#tiles = tiles as Tiles;
    this.#tiles.addEventListener('update-before', this.#update);
  }
  /** Called by the renderer, too. */
  dispose(): void {
    this.#tiles?.removeEventListener('update-before', this.#update);
    this.#tiles = undefined, (this.#sights = []);
    for (const { forget } of [...this.#meshes.values()]) forget();
    release(...this.#buffers.splice(0), this.#seen), (this.#seen = undefined);
  }

  /** Called by the renderer for each tile that it comes to: masks those that no camera can see. */
  calculateTileViewError(tile: unknown, target: ViewError): boolean {
    if (this.#sights.length === 0) return false;
    ++this.stats.tested;
    const { group } = this.#tiles!;
    (tile as Tile).engineData.boundingVolume.getAABB(this.#box);
    this.#box.applyMatrix4(group.matrixWorld);
    if (this.#box.isEmpty() || this.#sights.some((sight) => this.#maySee(sight)) || !this.#isOrdinary(tile as Tile)) return false;
    ++this.stats.hidden;
    target.inView = false;
    return true;
  }

  // What cannot be asked is drawn as ever, and said once.
  #tell(error: Error): void {
    if (!this.#told) console.warn(`Sightline masks no tiles: ${error.message}`);
    this.#told = true, (this.#sights = []);
  }

  #update = (): void => {
    this.#sights = [];
    Object.assign(this.stats, { occluders: 0, triangles: 0, tested: 0, hidden: 0 });
    const tiles = this.#tiles;
    if (!tiles || !this.enabled || !isLoaded()) return;
    const sights: Sight[] = [];
    try {
      if (!this.#isSound(tiles)) return;
      for (const camera of tiles.cameras) {
        const sight = this.#draw(camera, sights.length);
        if (!sight) return; // it may see everything
        sights.push(sight);
      }
      this.#sights = sights;
    } catch (error) {
      this.#tell(error as Error);
    }
  };

  // Whether what lies behind others cannot be seen, as far as is known of what is in the scene now.
  #isSound({ group, visibleTiles }: Tiles): boolean {
    let root: Object3D = group;
    for (let above: Object3D | null = group; above; above = above.parent) {
      if (isClipping(above) || above.renderOrder > 0) return false;
      root = above;
    }
    this.#override = (root as Scene).overrideMaterial ?? null, (this.#isLateBroken = breaksLateDepth(root));
    return !breaksDepth(root, this.#override) && [...visibleTiles].every((tile) => this.#isOrdinary(tile));
  }
  // Whether all that a tile holds, if it is loaded, can be hidden.
  #isOrdinary({ engineData: { scene } }: Tile): boolean {
    let is = true;
    scene?.traverseVisible((object) => {
      is &&= !isClipping(object) && canBeHidden(object as Mesh, this.#override, this.#isLateBroken);
    });
    return is;
  }

  #draw(camera: Camera, index: number): Sight | undefined {
    const { cameraMap, visibleTiles, group } = this.#tiles!, width = cameraMap.get(camera)?.width ?? 0;
    if (!(width >= 1)) return undefined;
    const eye = eyeOf(camera, Math.min(Math.round(width), 8192), 8192);
    if (!isRigid(eye) || isSkewed(eye)) return undefined;
    const buffer = (this.#buffers[index] ??= new OcclusionBuffer());
    buffer.begin(eye, { coverage: 'area' }); // for antialiasing, and canvases of another size
    const place = new Vector3(...(eye.origin as [number, number, number])).applyMatrix4(group.matrixWorldInverse);
    const near = [...visibleTiles].filter(({ engineData }) => engineData.scene)
      .map((tile) => ({ scene: tile.engineData.scene!, distance: tile.engineData.boundingVolume.distanceToPoint(place) }))
      .sort((a, b) => a.distance - b.distance);
    let left = this.#mostTriangles;
    setFrustum(camera);
    for (const { scene } of near) {
      scene.traverseVisible((object) => {
        if (left > 0 && (object as Mesh).isMesh) left -= this.#drawMesh(buffer, eye, object as Mesh, camera);
      });
      if (left <= 0) break;
    }
    this.stats.triangles += this.#mostTriangles - left;
    return { buffer, eye };
  }

  // Returns its triangles, where it was drawn.
  #drawMesh(buffer: OcclusionBuffer, eye: Eye, object: Mesh, camera: Camera): number {
    const m = object.matrixWorld.elements;
    if (!isPlain(object) || !mayOcclude(object, this.#override, camera) || !isInFrustum(object) || determinantOf(m) <= 0) return 0;
    const mark = markOf(object), isOther = typeof mark === 'object';
    const mesh = this.#meshOf(isOther ? mark : object.geometry, !isOther && materialsOf(object, this.#override).every(({ side }) => side === 2));
    if (!mesh) return 0;
    const transform = Array.from(m);
    for (let axis = 0; axis < 3; ++axis) transform[12 + axis]! -= eye.origin[axis]!;
    buffer.drawMesh(mesh, transform);
    ++this.stats.occluders;
    return mesh.triangles;
  }

  // Made when a geometry is seen first or anew when it has changed, and given back with it. Drawn from the front for some meshes
  // it is for all: that hides no more.
  #meshOf(geometry: BufferGeometry, both: boolean): OccluderMesh | null {
    const { drawRange, index, attributes: { position } } = geometry, corners = index?.count ?? position!.count;
    if (drawRange.start !== 0 || drawRange.count < corners) return null;
    const points = pointsOf(geometry), versions = points.version + (index?.version ?? 0), known = this.#meshes.get(geometry);
    if (known && known.points === points && known.index === index && known.versions === versions && (both || !known.both)) return known.mesh;
    known?.forget();
    const mesh = this.#make(geometry, corners, both), forget = (): void => {
      geometry.removeEventListener('dispose', forget);
      release(mesh), this.#meshes.delete(geometry);
    };
    geometry.addEventListener('dispose', forget);
    this.#meshes.set(geometry, { mesh, both, points, index, versions, forget });
    return mesh;
  }

  #make({ attributes, index, morphAttributes }: BufferGeometry, corners: number, both: boolean): OccluderMesh | null {
    const position = attributes.position!;
    // What lies on the GPU alone cannot be read.
    if (!('getX' in position) || (index && !('getX' in index)) || morphAttributes.position) return null;
    if (corners < 3 || corners % 3 !== 0 || corners > 3 * this.#mostTriangles) return null;
    const points = new Float32Array(3 * position.count);
    for (let i = 0; i < position.count; ++i) points.set([position.getX(i), position.getY(i), position.getZ(i)], 3 * i);
    const indices = Uint32Array.from({ length: corners }, (_, i) => (index ? index.getX(i) : i));
    try {
      return new OccluderMesh(points, indices, both ? 'both' : 'front');
    } catch {
      return null; // not sound: it hides nothing
    }
  }

  // The box grows by a pixel at its depth and a little, so that a surface does not hide the tile that it belongs to.
  #maySee({ buffer, eye }: Sight): boolean {
    const { min, max } = this.#box, seen = (this.#seen ??= bytes(1));
    const flat = eye.eyeToClip[15] === 1, size = max.distanceTo(min);
    let far = size;
    for (let axis = 0; axis < 3; ++axis) far += Math.abs(min.getComponent(axis) - eye.origin[axis]!);
    const grow = 1e-4 * size + (flat ? 1 : far) * (2 / (eye.height * Math.abs(eye.eyeToClip[5]!)));
    for (let axis = 0; axis < 3; ++axis) {
      this.#numbers[axis] = min.getComponent(axis) - grow;
      this.#numbers[3 + axis] = max.getComponent(axis) + grow;
    }
    if (!this.#numbers.every(Number.isFinite)) return true;
    buffer.maySee(this.#numbers, seen);
    return seen.array[0] !== 0;
  }
}
