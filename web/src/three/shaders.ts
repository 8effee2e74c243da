// What shaders of one's own do that no box or matrix says.
import { Material, ShaderChunk } from 'three';

type Shaders = Material & { vertexShader?: string; fragmentShader?: string };

// With what it includes, but for three's own chunks that name such words only where other marks show that they count.
const own = ['morphinstance_vertex', 'logdepthbuf_fragment'];
function whole(shader: string, depth = 8): string {
  return shader.replace(/^[ \t]*#include +<([\w\d./]+)>/gm, (_, name: string) =>
    depth === 0 || own.includes(name) ? '' : whole((ShaderChunk as Record<string, string>)[name] ?? '', depth - 1));
}

// Whether one of a material's own shaders has a word in it; looked for once for as long as it stays.
function has(which: 'vertexShader' | 'fragmentShader', word: string): (material: Material) => boolean {
  const known = new WeakMap<Material, { shader: string; found: boolean }>();
  return (material) => {
    const shader = (material as Shaders)[which];
    if (typeof shader !== 'string') return false;
    let one = known.get(material);
    if (one?.shader !== shader) known.set(material, (one = { shader, found: whole(shader).includes(word) }));
    return one.found;
  };
}
const numbersInstances = has('vertexShader', 'gl_InstanceID');

/** Whether it writes a depth of its own, so that it may be seen through what is nearer. */
export const writesDepth = has('fragmentShader', 'gl_FragDepth');

/** Whether three's shader for it is changed by somebody before it is compiled. */
export const isPatched = (material: Material): boolean => material.onBeforeCompile !== Material.prototype.onBeforeCompile;

/** Whether it has a callback of its own or of its class, which three calls whenever it draws something with it. */
export const callsBack = (material: Material | Material[] | null | undefined): boolean => Array.isArray(material)
  ? material.some(callsBack) : material?.onBeforeRender !== undefined && material.onBeforeRender !== Material.prototype.onBeforeRender;

/** Whether vertices may be elsewhere than their geometry has them, though within three's sphere around that: where a shader of
 * somebody's own turns them towards the camera. */
export const movesVertices = (material: Material | Material[] | null | undefined): boolean => {
  if (Array.isArray(material)) return material.some(movesVertices);
  const one = material as (Material & { isShaderMaterial?: boolean; positionNode?: unknown; vertexNode?: unknown }) | null | undefined;
  return one != null && Boolean(one.isShaderMaterial || one.positionNode || one.vertexNode || isPatched(one));
};

/** Whether it may draw another instance where other instances are left out. */
export const countsInstances = (material: Material | null | undefined): boolean =>
  material != null && (numbersInstances(material) || isPatched(material));
