// What three is told of an InstancedMesh's attributes: `updateRanges`, of which we take note before three sends and forgets them;
// and what three has not sent, because a shorter copy was drawn in the attribute's place.
import type { InstancedBufferAttribute } from 'three';
import { restore } from './restore.js';

type Attribute = InstancedBufferAttribute;

/** More of them cost more than looking at all. */
const most = 4096;

/** What of an attribute was set since somebody last looked. */
export class Ranges {
  /** Another attribute has taken its place; or all of it may have been set. */
  isOther = true;
  isWhole = false;
  /** Numbers first … end - 1 of each range, one after the other. */
  readonly list: number[] = [];
  #attribute: Attribute | undefined;
  #version = -1;

  /** To be called in every frame, before three draws. */
  note(attribute: Attribute): void {
    const { version, updateRanges } = attribute;
    if (attribute !== this.#attribute) this.isOther = true;
    else if (version !== this.#version && (updateRanges.length === 0 || this.list.length > 2 * most)) this.isWhole = true;
    else if (version !== this.#version) for (const { start, count } of updateRanges) this.list.push(start, start + count);
    this.#attribute = attribute, (this.#version = version);
    remind(attribute);
  }
  get isEmpty(): boolean {
    return !this.isOther && !this.isWhole && this.list.length === 0;
  }
  forget(): void {
    this.isOther = this.isWhole = false, (this.list.length = 0);
  }
}

const unsent = new WeakSet<Attribute>();

/** To be called where three is not shown an attribute: it then sends the whole of it when it next does, not only the ranges that
 * are added until then. */
export function withhold(attribute: Attribute): void {
  attribute.clearUpdateRanges();
  if (unsent.has(attribute)) return;
  unsent.add(attribute);
  const own = Object.getOwnPropertyDescriptor(attribute, 'onUploadCallback'), { onUploadCallback } = attribute;
  attribute.onUploadCallback = () => {
    unsent.delete(attribute), restore(attribute, 'onUploadCallback', own);
    onUploadCallback.call(attribute);
  };
}
export const isUnsent = (attribute: Attribute | null): boolean => attribute !== null && unsent.has(attribute);
/** To be called before three draws it after all. */
export function remind(attribute: Attribute | null): void {
  if (isUnsent(attribute)) attribute!.clearUpdateRanges();
}
/** The same for when nobody will do that any more. */
export function letGo(attribute: Attribute | null): void {
  if (isUnsent(attribute)) attribute!.addUpdateRange(0, attribute!.array.length);
}
