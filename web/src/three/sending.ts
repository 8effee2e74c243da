// Which of a batch's matrices go to the GPU. Where one has changed three sends all; a culled batch needs those that are
// drawn. So we send what is drawn and has changed, and while it is drawn its texture has the version that three sent last;
// then its own again, so that without the culler three sends all as ever. (Through three's own `updateRanges`, which
// ask WebGL for its state first, a frame took longer.)
import type { Batch, DataTexture } from './batches.js';

/** What is used of a WebGLRenderer. */
export interface Sender {
  properties?: { get(texture: object): { __version?: number; __webglTexture?: WebGLTexture } };
  state?: { bindTexture(kind: number, texture: WebGLTexture): void };
  getContext?(): WebGL2RenderingContext;
}

/** More matrices one by one cost as much as all together. */
const most = 64;
const sent = new Uint32Array(most);

export class Sending {
  // By which version an instance had changed last; 0 where we have sent that to #to.
  readonly #changed: Uint32Array;
  // By which version any may have.
  #all = 0;
  #to: Sender | undefined;
  #drawing: { texture: DataTexture<Float32Array>; own: number; given: number } | undefined;

  constructor(instances: number) {
    this.#changed = new Uint32Array(instances);
  }
  /** An instance has another matrix in this version. */
  note(instance: number, version: number): void {
    this.#changed[instance] = version;
  }
  /** Any may have. */
  noteAll(version: number): void {
    this.#all = version;
  }

  /** Just before the first `count` of the instances are drawn; everything up to `version` was noted. */
  begin(to: Sender, { _matricesTexture: texture }: Batch, version: number, instances: Uint32Array, count: number): void {
    this.end();
    if (!to.properties || texture.version !== version || texture.updateRanges?.length !== 0) return;
    const { __version: known, __webglTexture: place } = to.properties.get(texture);
    if (this.#to !== to) this.#to = to, (this.#all = version);
    if (known === undefined || known < this.#all || known === version || !place) return;
    let changed = 0;
    for (let k = 0; k < count; ++k) {
      if (this.#changed[instances[k]!]! <= known) continue;
      if (changed === most) return;
      sent[changed++] = instances[k]!;
    }
    if (changed > 0) this.#send(texture, place, changed);
    this.#drawing = { texture, own: version, given: known };
    texture.version = known;
  }
  /** When they were. */
  end(): void {
    if (!this.#drawing) return;
    const { texture, own, given } = this.#drawing;
    texture.version += own - given; // what was counted up meanwhile stays so
    this.#drawing = undefined;
  }

  #send({ image: { data, width } }: DataTexture<Float32Array>, place: WebGLTexture, count: number): void {
    const gl = this.#to!.getContext!();
    this.#to!.state!.bindTexture(gl.TEXTURE_2D, place);
    // As three sets them whenever it sends.
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false), gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
    for (const instance of sent.subarray(0, count)) {
      const texel = 4 * instance;
      gl.texSubImage2D(gl.TEXTURE_2D, 0, texel % width, Math.floor(texel / width), 4, 1, gl.RGBA, gl.FLOAT, data, 4 * texel);
      this.#changed[instance] = 0;
    }
  }
}
