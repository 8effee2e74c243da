// The device, its buffers and passes: what casts the rays of iwcpa, bvha and saa.
import { refuse, refuseProxy, said } from '../errors.js';
import { isA, readOptions } from '../memory.js';
import { RaySet, type RayHits } from './rays.js';
import * as shaders from './shaders.js';

/** Every pair of ray and box, as printed and tuned; candidates from the CPU's tree; the tree laid flat. */
export const gpuMethods = ['iwcpa', 'tuned-iwcpa', 'bvha', 'saa'] as const;
export type GpuMethod = (typeof gpuMethods)[number];

/** Milliseconds of a cast: walking the tree here, sending, computing, and fetching the hits. */
export interface CastTimes { cpu: number; upload: number; compute: number; readBack: number }
export interface GpuHits extends RayHits { times: CastTimes }

/** Whether this browser has WebGPU at all; GpuRays.start() says whether it has a device. */
export const hasWebGpu: boolean = typeof navigator === 'object' && Boolean(navigator.gpu);

const isDevice = (given: GPUDevice | undefined): boolean => typeof given?.createShaderModule === 'function';

type Pipelines = Record<keyof typeof shaders, GPUComputePipeline>;
type Pass = { pipeline: GPUComputePipeline; buffers: GPUBuffer[]; call: [number, number, number, number]; x: number; y: number };

/** Of a round of iwcpa, so that many boxes need no more memory. */
const roundBytes = 16 << 20;
const callBytes = 256; // apart, as offsets of uniforms must be
const disposed = 'GpuRays: used after dispose()';
const strip = 1024; // boxes to a workgroup of tunedPairs

/** A GPU that casts rays. */
export class GpuRays {
  /** The adapter's own words, where it says any. */
  readonly name: string;
  readonly #device: GPUDevice;
  readonly #own: boolean;
  readonly #pipelines: Pipelines;
  readonly #buffers = new Map<string, GPUBuffer>();
  readonly #lost: Promise<never>;
  #sent: { set: RaySet; version: number } | undefined;
  #end: string | undefined;
  #busy: Promise<unknown> = Promise.resolve();

  private constructor(device: GPUDevice, own: boolean, name: string, pipelines: Pipelines) {
    if (!isDevice(device)) refuse('GpuRays: made by `new`, expected `await GpuRays.start()`');
    this.#device = device;
    this.#own = own;
    this.#pipelines = pipelines;
    this.name = name;
    this.#lost = device.lost.then(({ message, reason }) => {
      this.#end ??= `sightline: the GPU's device was lost (${message || reason || 'no reason given'}); start another, or cast on the CPU`;
      return this.#refuse();
    });
    this.#lost.catch(() => {}); // whoever casts is told
  }

  /** Asks the browser for a device, or takes a `GPUDevice` of yours, and compiles. Rejects with code `unsupported` where there is
   * no WebGPU, no adapter or no device. */
  static async start(options?: { device?: unknown }): Promise<GpuRays> {
    const given = readOptions('GpuRays.start', options, ['device'])[0] as GPUDevice | undefined;
    let device = given, name = '';
    if (given && !isDevice(given)) refuse('GpuRays.start: a device that is none, expected a GPUDevice');
    if (!device) {
      if (!hasWebGpu) refuse('sightline: this browser has no WebGPU, expected one that has; cast on the CPU', 'unsupported');
      const adapter = await navigator.gpu.requestAdapter().catch(() => null);
      if (!adapter) refuse('sightline: WebGPU has no adapter here, expected a GPU that the browser allows; cast on the CPU', 'unsupported');
      const { vendor, architecture, description } = adapter.info ?? {};
      name = description || [vendor, architecture].filter(Boolean).join(' ');
      try {
        device = await adapter.requestDevice();
      } catch (error) {
        refuse(`sightline: WebGPU gave no device (${(error as Error).message}); cast on the CPU`, 'unsupported');
      }
    }
    const made: [string, GPUComputePipeline][] = [];
    for (const [key, code] of Object.entries(shaders)) {
      const module = device.createShaderModule({ label: key, code });
      const pipeline = await device.createComputePipelineAsync({ label: key, layout: 'auto', compute: { module } })
        .catch((error: Error) => refuse(`sightline: the GPU's compiler refused ${key} (${error.message})`, 'unsupported'));
      made.push([key, pipeline]);
    }
    return new GpuRays(device, !given, name, Object.fromEntries(made) as Pipelines);
  }

  /** Resolves with a sentence when the device is lost. */
  get lost(): Promise<string> {
    return GpuRays.#of(this).#lost.catch((error: Error) => error.message);
  }

  /** Casts a set's rays. One cast at a time; others wait. Rejects with code `lost` where the device is lost meanwhile, and
   * `too_many` where it has not the memory. */
  async cast(set: RaySet, method: GpuMethod): Promise<GpuHits> {
    if (!isA(set, RaySet)) refuse('cast: expected a RaySet');
    if (!gpuMethods.includes(method)) refuse(`cast: a method of ${said(method)}, expected ${gpuMethods.join(', ')}`);
    const gpu = GpuRays.#of(this), cast = gpu.#busy.then(() => gpu.#cast(set, method));
    gpu.#busy = cast.catch(() => {});
    return cast;
  }

  /** Gives the GPU's memory back, and the device unless it was yours. */
  dispose(): void {
    if (GpuRays.#of(this).#end) return;
    this.#end = disposed;
    for (const buffer of this.#buffers.values()) buffer.destroy();
    this.#buffers.clear();
    if (this.#own) this.#device.destroy();
  }

  async #cast(set: RaySet, method: GpuMethod): Promise<GpuHits> {
    this.#check();
    const { rays, size } = set;
    const hits = { objects: new Uint32Array(rays).fill(0xffffffff), distances: new Float32Array(rays).fill(-1),
      times: { cpu: 0, upload: 0, compute: 0, readBack: 0 } };
    if (rays === 0 || size === 0) return hits;
    const clock = stopwatch();
    if (method === 'bvha') set.collect();
    hits.times.cpu = clock();
    this.#device.pushErrorScope('out-of-memory');
    this.#device.pushErrorScope('validation');
    try {
      this.#send(set, method);
      hits.times.upload = clock();
      this.#compute(this.#passes(set, method), rays);
      await this.#settled();
      hits.times.compute = clock();
      await this.#read(hits, rays);
      hits.times.readBack = clock();
    } finally {
      await this.#judge();
    }
    return hits;
  }

  static #of(gpu: GpuRays): GpuRays {
    return #busy in Object(gpu) ? gpu : refuseProxy('GpuRays');
  }
  #check(): void {
    if (this.#end) this.#refuse();
  }
  #refuse(): never {
    refuse(this.#end!, this.#end === disposed ? 'disposed' : 'lost');
  }

  // The GPU has done what it was given; refuses where it is lost instead.
  async #settled(): Promise<void> {
    await Promise.race([this.#device.queue.onSubmittedWorkDone(), this.#lost]);
    this.#check();
  }

  async #judge(): Promise<void> {
    if (this.#end) return;
    const wrong = (await this.#device.popErrorScope()) ?? (await this.#device.popErrorScope());
    if (wrong) refuse(`sightline: the GPU refused the rays (${wrong.message})`, 'too_many');
  }

  // A buffer of at least so many bytes.
  #room(name: string, bytes: number, usage: GPUBufferUsageFlags = GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST): GPUBuffer {
    const most = Math.min(this.#device.limits.maxStorageBufferBindingSize, this.#device.limits.maxBufferSize);
    if (bytes > most) refuse(`sightline: ${bytes} bytes of ${name}, and this GPU takes ${most}; cast fewer rays`, 'too_many');
    let buffer = this.#buffers.get(name);
    if (buffer && buffer.size >= bytes) return buffer;
    buffer?.destroy();
    buffer = this.#device.createBuffer({ label: name, size: Math.max(256, Math.ceil(bytes / 4) * 4), usage });
    this.#buffers.set(name, buffer);
    return buffer;
  }
  #write(name: string, bytes: Uint8Array<ArrayBuffer>): void {
    this.#device.queue.writeBuffer(this.#room(name, bytes.byteLength), 0, bytes);
  }

  #send(set: RaySet, method: GpuMethod): void {
    if (this.#sent?.set !== set || this.#sent.version !== set.version) {
      this.#write('boxes', set.bytes('boxes')), this.#write('nodes', set.bytes('nodes'));
      this.#sent = { set, version: set.version };
    }
    this.#write('rays', set.bytes('rays'));
    if (method === 'bvha') for (const name of ['candidates', 'first', 'owners'] as const) this.#write(name, set.bytes(name));
  }

  #passes(set: RaySet, method: GpuMethod): Pass[] {
    const { rays, size } = set, groups = Math.ceil(rays / 256);
    const b = (name: string) => this.#buffers.get(name)!;
    const hits = this.#room('hits', 8 * rays, GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC);
    if (method === 'iwcpa') return this.#pairs(rays, size, hits);
    if (method === 'tuned-iwcpa') return this.#tunedPairs(rays, size, hits);
    if (method === 'saa') {
      return [{ pipeline: this.#pipelines.saa, buffers: [b('rays'), b('nodes'), hits], call: [rays, 0, set.count('nodes'), 0],
        x: groups, y: 1 }];
    }
    const count = set.count('candidates'), distances = this.#room('distances', 4 * count), wide = Math.ceil(count / 256);
    const x = Math.min(wide, 65535);
    return [
      { pipeline: this.#pipelines.bvhaDistances, buffers: [b('rays'), b('boxes'), b('candidates'), b('owners'), distances],
        call: [rays, 0, count, 0], x, y: x > 0 ? Math.ceil(wide / x) : 0 },
      { pipeline: this.#pipelines.bvhaNearest, buffers: [b('candidates'), b('first'), distances, hits], call: [rays, 0, 0, 0],
        x: groups, y: 1 }];
  }

  #pairs(rays: number, size: number, hits: GPUBuffer): Pass[] {
    const step = Math.min(size, Math.max(1, Math.floor(roundBytes / (4 * rays))));
    const distances = this.#room('distances', 4 * step * rays), passes: Pass[] = [];
    for (let first = 0; first < size; first += step) {
      const end = Math.min(first + step, size), call = [rays, first, end, first > 0 ? 1 : 0] as Pass['call'];
      passes.push({ pipeline: this.#pipelines.iwcpaDistances, buffers: [this.#buffers.get('rays')!, this.#buffers.get('boxes')!, distances],
        call, x: Math.ceil(rays / 16), y: Math.ceil((end - first) / 16) });
      passes.push({ pipeline: this.#pipelines.iwcpaNearest, buffers: [distances, hits], call, x: Math.ceil(rays / 256), y: 1 });
    }
    return passes;
  }

  #tunedPairs(rays: number, size: number, hits: GPUBuffer): Pass[] {
    const fit = Math.max(1, Math.floor(roundBytes / (16 * 8 * rays))), strips = Math.min(fit, Math.ceil(size / strip));
    const nearest = this.#room('nearest', strips * 16 * 8 * rays), passes: Pass[] = [];
    for (let first = 0; first < size; first += strips * strip) {
      const some = Math.min(strips, Math.ceil((size - first) / strip));
      passes.push({ pipeline: this.#pipelines.tunedPairs, buffers: [this.#buffers.get('rays')!, this.#buffers.get('boxes')!, nearest],
        call: [rays, first, size, 0], x: Math.ceil(rays / 16), y: some });
      passes.push({ pipeline: this.#pipelines.tunedNearest, buffers: [nearest, hits], call: [rays, 0, 16 * some, first > 0 ? 1 : 0],
        x: Math.ceil(rays / 256), y: 1 });
    }
    return passes;
  }

  #compute(passes: readonly Pass[], rays: number): void {
    const calls = this.#room('calls', callBytes * passes.length, GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST);
    const numbers = new Uint32Array((callBytes / 4) * passes.length);
    passes.forEach(({ call }, i) => numbers.set(call, (callBytes / 4) * i));
    this.#device.queue.writeBuffer(calls, 0, numbers);
    const commands = this.#device.createCommandEncoder(), pass = commands.beginComputePass();
    passes.forEach(({ pipeline, buffers, x, y }, i) => {
      if (x === 0 || y === 0) return;
      const uniform = { binding: 0, resource: { buffer: calls, offset: callBytes * i, size: 16 } };
      const entries = [uniform, ...buffers.map((buffer, k) => ({ binding: k + 1, resource: { buffer } }))];
      pass.setPipeline(pipeline);
      pass.setBindGroup(0, this.#device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
      pass.dispatchWorkgroups(x, y);
    });
    pass.end();
    const read = this.#room('read', 8 * rays, GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST);
    commands.copyBufferToBuffer(this.#buffers.get('hits')!, 0, read, 0, 8 * rays);
    this.#device.queue.submit([commands.finish()]);
  }

  async #read(hits: RayHits, rays: number): Promise<void> {
    const read = this.#buffers.get('read')!;
    await Promise.race([read.mapAsync(GPUMapMode.READ, 0, 8 * rays).catch((error: Error) => {
      this.#check();
      refuse(`sightline: the GPU gave no hits (${error.message})`, 'lost');
    }), this.#lost]);
    const found = read.getMappedRange(0, 8 * rays), objects = new Uint32Array(found), distances = new Float32Array(found);
    for (let r = 0; r < rays; ++r) {
      hits.objects[r] = objects[2 * r]!;
      hits.distances[r] = objects[2 * r] === 0xffffffff ? -1 : distances[2 * r + 1]!;
    }
    read.unmap();
  }
}

// Milliseconds since it was asked last.
function stopwatch(): () => number {
  let last = performance.now();
  return () => {
    const before = last;
    return (last = performance.now()) - before;
  };
}
