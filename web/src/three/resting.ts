// InstancedMeshes that are left to three because much of them moved in every frame, until little of them is set.
import type { InstancedBufferAttribute, InstancedMesh, Object3D } from 'three';

interface Left { object: Object3D; parent: number }
interface Seen { matrix: InstancedBufferAttribute; version: number; frames: number }

/** Frames in which nothing was set, or only ranges of less than a quarter. */
const calmFrames = 16;

export class Resting {
  readonly #seen = new Map<Left, Seen>();

  add(left: Left): void {
    const { instanceMatrix: matrix } = left.object as InstancedMesh;
    this.#seen.set(left, { matrix, version: matrix.version, frames: 0 });
  }
  has(left: Left): boolean {
    return this.#seen.has(left);
  }
  delete(left: Left): void {
    this.#seen.delete(left);
  }
  clear(): void {
    this.#seen.clear();
  }
  /** Those that have come to rest, which are forgotten; to be called once a frame. */
  calm(): Left[] {
    const calm: Left[] = [];
    for (const [left, seen] of this.#seen) {
      const { instanceMatrix } = left.object as InstancedMesh, { version, updateRanges, array } = instanceMatrix;
      const told = updateRanges.reduce((sum, { count }) => sum + count, 0), isLittle = told > 0 && 4 * told < array.length;
      const stays = instanceMatrix === seen.matrix && (version === seen.version || isLittle);
      Object.assign(seen, { matrix: instanceMatrix, version, frames: stays ? seen.frames + 1 : 0 });
      if (seen.frames >= calmFrames) calm.push(left), this.#seen.delete(left);
    }
    return calm;
  }
}
