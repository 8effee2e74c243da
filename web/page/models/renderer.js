// Draws a model of strata with WebGL 2: one buffer of vertices, one of indices, a range a mesh, and one call for all of them.
import { multiply } from '../ui/matrices.js';
import { vertexBytes } from './models.js';

const common = `#version 300 es
precision highp float; precision highp int; precision highp usampler2D;
`;
const lit = {
  vertex: `${common}
layout(location = 0) in vec3 position; layout(location = 1) in vec3 normal; layout(location = 2) in uint object;
uniform mat4 clip; uniform vec3 offset; uniform usampler2D objects;
uniform vec3 palette[28];
uniform vec3 keptColour, culledColour; uniform bool byState;
out vec3 colour, facing; out vec3 place;
void main() {
  uvec4 about = texelFetch(objects, ivec2(int(object) & 255, int(object) >> 8), 0);
  colour = byState ? (about.g == 1u ? keptColour : culledColour) : palette[about.r];
  facing = normal; place = position + offset;
  gl_Position = clip * vec4(place, 1.0);
}`,
  fragment: `${common}
in vec3 colour, facing, place; uniform vec3 eye, haze; out vec4 pixel;
void main() {
  vec3 n = normalize(facing);
  float sun = max(dot(n, normalize(vec3(0.55, 0.75, 0.35))), 0.0), sky = 0.5 + 0.5 * n.y;
  vec3 shaded = colour * (0.34 + 0.30 * sky + 0.62 * sun) + vec3(0.05, 0.035, 0.02) * sun;
  float far = clamp((distance(place, eye) - 22000.0) / 90000.0, 0.0, 0.35);
  pixel = vec4(mix(shaded, haze, far), 1.0);
}` };
const items = {
  vertex: `${common}
layout(location = 0) in vec3 position; layout(location = 2) in uint object;
uniform mat4 clip; uniform vec3 offset; flat out uint item;
void main() { item = object + 1u; gl_Position = clip * vec4(position + offset, 1.0); }`,
  fragment: `${common}
flat in uint item; out vec4 pixel;
void main() { pixel = vec4(float(item & 255u), float((item >> 8) & 255u), float((item >> 16) & 255u), 255.0) / 255.0; }` };

function program(gl, { vertex, fragment }) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source), gl.compileShader(shader), gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(made));
  return made;
}

// Ochre, sienna, sand, slate, moss: beds of a geological map, light and dark by turns so that each shows.
const anchors = [[92, 78, 74], [138, 94, 70], [186, 128, 84], [214, 168, 106], [232, 202, 146], [176, 170, 122], [120, 140, 112],
  [98, 122, 132], [150, 130, 140], [204, 150, 118], [236, 214, 176]];
function palette(layers) {
  const out = new Float32Array(28 * 3);
  for (let layer = 0; layer < layers; ++layer) {
    const at = (layer / Math.max(1, layers - 1)) * (anchors.length - 1), k = Math.min(Math.floor(at), anchors.length - 2);
    const light = layer % 2 ? 1.06 : 0.9;
    for (let c = 0; c < 3; ++c)
      out[3 * layer + c] = Math.min(1, (light * (anchors[k][c] + (anchors[k + 1][c] - anchors[k][c]) * (at - k))) / 255);
  }
  return out;
}

export class ModelRenderer {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = canvas.getContext('webgl2', { antialias: true, alpha: true, powerPreference: 'high-performance' });
    if (!gl) throw new Error('This browser has no WebGL 2, which draws the models.');
    this.gl = gl;
    this.multi = gl.getExtension('WEBGL_multi_draw');
    this.lit = program(gl, lit), (this.items = program(gl, items));
    this.array = gl.createVertexArray();
    this.vertices = gl.createBuffer(), (this.indices = gl.createBuffer());
    this.objects = gl.createTexture();
    this.targets = new Map();
    gl.enable(gl.DEPTH_TEST), gl.enable(gl.CULL_FACE);
  }

  /** The GPU's name as WebGL tells it. */
  get name() {
    const told = this.gl.getExtension('WEBGL_debug_renderer_info');
    return this.gl.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : this.gl.RENDERER);
  }

  /** Makes a model's meshes and sends them, some at a time; `progress` hears the share done. Returns boxes, offset and plan. */
  async load(models, plan, progress = () => {}) {
    const { gl } = this;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.vertices), gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bufferData(gl.ARRAY_BUFFER, plan.vertexCount * vertexBytes, gl.STATIC_DRAW);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, plan.indexCount * 4, gl.STATIC_DRAW);
    if (gl.getError() === gl.OUT_OF_MEMORY) throw new Error('The GPU has no room for so many triangles; choose fewer.');
    gl.enableVertexAttribArray(0), gl.vertexAttribPointer(0, 3, gl.FLOAT, false, vertexBytes, 0);
    gl.enableVertexAttribArray(1), gl.vertexAttribPointer(1, 3, gl.BYTE, true, vertexBytes, 12);
    gl.enableVertexAttribArray(2), gl.vertexAttribIPointer(2, 1, gl.UNSIGNED_INT, vertexBytes, 16);
    this.plan = plan;
    this.first = new Uint32Array(plan.count);
    let vertex = 0, index = 0, last = performance.now();
    for (let piece = 0; piece < plan.count; ++piece) {
      const mesh = models.make(piece), moved = mesh.indices.map((i) => i + vertex);
      gl.bufferSubData(gl.ARRAY_BUFFER, vertex * vertexBytes, mesh.vertices);
      gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, index * 4, moved);
      this.first[piece] = index;
      vertex += plan.vertices[piece], (index += plan.indices[piece]);
      if (performance.now() - last > 30) {
        progress(piece / plan.count);
        await new Promise((resolve) => setTimeout(resolve));
        last = performance.now();
        gl.bindVertexArray(this.array), gl.bindBuffer(gl.ARRAY_BUFFER, this.vertices);
      }
    }
    const { offset, boxes } = models.centre();
    this.offset = offset;
    this.#describe(plan);
    return boxes;
  }

  // A texel an object: its layer, and whether it is kept.
  #describe({ count, layers }) {
    const { gl } = this, rows = Math.ceil(count / 256);
    this.about = new Uint8Array(4 * 256 * rows);
    for (let i = 0; i < count; ++i) this.about[4 * i] = layers[i];
    this.palette = palette(Math.max(...layers) + 1);
    gl.bindTexture(gl.TEXTURE_2D, this.objects);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST), gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8UI, 256, rows, 0, gl.RGBA_INTEGER, gl.UNSIGNED_BYTE, this.about);
    this.all = Uint32Array.from({ length: count }, (_, i) => i);
    this.counts = new Int32Array(count), (this.offsets = new Int32Array(count));
  }

  /** Colours what is kept and what is not. */
  tell(kept) {
    const { gl } = this;
    for (let i = 0; i < this.plan.count; ++i) this.about[4 * i + 1] = 0;
    for (const object of kept) this.about[4 * object + 1] = 1;
    gl.bindTexture(gl.TEXTURE_2D, this.objects);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 256, this.about.length / 1024, gl.RGBA_INTEGER, gl.UNSIGNED_BYTE, this.about);
  }

  /** Draws objects; `target` none: the canvas. Returns the triangles. */
  draw(view, objects, { target, byState = false, look, background } = {}) {
    const { gl } = this, [width, height] = target ? [target.width, target.height] : [this.canvas.width, this.canvas.height];
    gl.bindFramebuffer(gl.FRAMEBUFFER, target?.frame ?? null);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...(background ?? [0, 0, 0, 0])), gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.lit);
    const at = (name) => gl.getUniformLocation(this.lit, name);
    gl.uniform3fv(at('palette'), this.palette), gl.uniform3fv(at('eye'), view.eye), gl.uniform3fv(at('haze'), look.haze);
    gl.uniform3fv(at('keptColour'), look.kept), gl.uniform3fv(at('culledColour'), look.culled), gl.uniform1i(at('byState'), byState ? 1 : 0);
    return this.#submit(this.lit, view, objects);
  }

  /** Which object shows in each pixel of width × height, plus one; 0 for none. */
  itemBuffer(view, width, height) {
    const { gl } = this, target = this.target(width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame), gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0), gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.items);
    this.#submit(this.items, view, this.all);
    const bytes = this.read(target), found = new Uint32Array(width * height);
    for (let p = 0; p < found.length; ++p) found[p] = bytes[4 * p] | (bytes[4 * p + 1] << 8) | (bytes[4 * p + 2] << 16);
    return found;
  }

  /** A picture's pixels, from the bottom row on; waits until it is drawn. */
  read(target) {
    const { gl } = this, bytes = new Uint8Array(4 * target.width * target.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    gl.readPixels(0, 0, target.width, target.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return bytes;
  }
  /** Waits until all is drawn. */
  finish(target) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target?.frame ?? null);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  /** Somewhere to draw to, without a window. */
  target(width, height) {
    const { gl } = this, key = `${width} ${height}`;
    if (this.targets.has(key)) return this.targets.get(key);
    const made = { width, height, frame: gl.createFramebuffer() }, colour = gl.createRenderbuffer(), depth = gl.createRenderbuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, made.frame);
    for (const [buffer, format, at] of [[colour, gl.RGBA8, gl.COLOR_ATTACHMENT0], [depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer), gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, at, gl.RENDERBUFFER, buffer);
    }
    this.targets.set(key, made);
    return made;
  }

  #submit(used, view, objects) {
    const { gl, plan } = this;
    gl.uniformMatrix4fv(gl.getUniformLocation(used, 'clip'), false, multiply(view.projection, view.worldToEye));
    gl.uniform3fv(gl.getUniformLocation(used, 'offset'), this.offset);
    gl.bindVertexArray(this.array), gl.bindTexture(gl.TEXTURE_2D, this.objects);
    // Neighbours in the buffer become one range.
    let ranges = 0, triangles = 0, end = -1;
    for (const object of objects) {
      const count = plan.indices[object], start = this.first[object];
      if (start === end) this.counts[ranges - 1] += count;
      else (this.counts[ranges] = count), (this.offsets[ranges++] = 4 * start);
      end = start + count, (triangles += count / 3);
    }
    if (this.multi) {
      this.multi.multiDrawElementsWEBGL(gl.TRIANGLES, this.counts, 0, gl.UNSIGNED_INT, this.offsets, 0, ranges);
    } else {
      for (let k = 0; k < ranges; ++k) gl.drawElements(gl.TRIANGLES, this.counts[k], gl.UNSIGNED_INT, this.offsets[k]);
    }
    return triangles;
  }
}
