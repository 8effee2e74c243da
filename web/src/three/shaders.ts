// What shaders of one's own do that no box or matrix says.
import { Material } from 'three';

type Shaders = Material & { vertexShader?: string; fragmentShader?: string };

// Whether one of a material's own shaders has a word in it; looked for once for as long as it stays.
function has(which: 'vertexShader' | 'fragmentShader', word: string): (material: Material) => boolean {
  const known = new WeakMap<Material, { shader: string; found: boolean }>();
  return (material) => {
    const shader = (material as Shaders)[which];
    if (typeof shader !== 'string') return false;
    let one = known.get(material);
    if (one?.shader !== shader) known.set(material, (one = { shader, found: shader.includes(word) }));
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

/** Whether it may draw another instance where other instances are left out. */
export const countsInstances = (material: Material | null | undefined): boolean =>
  material != null && (numbersInstances(material) || isPatched(material));
