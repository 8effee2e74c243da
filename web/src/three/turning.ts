// Whether a shader of somebody's own may put an object's points elsewhere within three's sphere around them.
import type { Box3, Mesh } from 'three';
import { turned } from './bounds.js';
import { movesVertices } from './shaders.js';

/** What is known of an object's material, from one look to the next. */
export class Turning {
  /** Whether it may, as of what turns towards the camera. A mark on the object vouches that it does not. */
  may = false;
  #material: unknown;
  #version = NaN;
  #isVouched = false;

  /** Of a box of its points one that holds them wherever they are. */
  around(box: Box3): Box3 {
    return this.may ? turned(box) : box;
  }

  /** Looks again; whether it is otherwise now. */
  changes({ material, userData }: Mesh): boolean {
    const isVouched = userData?.sightline === true || userData?.occluder === true;
    const version = (material as { version?: number } | null)?.version ?? NaN; // of several: they are looked at again
    if (material === this.#material && version === this.#version && isVouched === this.#isVouched) return false;
    this.#material = material, (this.#version = version), (this.#isVouched = isVouched);
    const before = this.may;
    return (this.may = !isVouched && movesVertices(material)) !== before;
  }
}
