// Numbers as web/test/writer.hpp wrote them.
export class Reader {
  #data; #at = 0;
  constructor(buffer) { this.#data = buffer; }
  many(kind, count) {
    const bytes = count * kind.BYTES_PER_ELEMENT;
    const copy = this.#data.buffer.slice(this.#data.byteOffset + this.#at, this.#data.byteOffset + this.#at + bytes);
    this.#at += bytes;
    return new kind(copy);
  }
  integer() { return this.many(Uint32Array, 1)[0]; }
  view() {
    const [worldToEye, eyeToClip] = [this.many(Float32Array, 16), this.many(Float32Array, 16)];
    return { worldToEye, eyeToClip, width: this.integer(), height: this.integer(), origin: this.many(Float64Array, 3) };
  }
  get left() { return this.#data.length - this.#at; }
}
