// The five models of strata, made mesh by mesh by strata.wasm (web/paper/strata.cpp).

/** The paper's, by number. */
export const names = ['Wuzhishan geological model', 'Wuzhishan strata', 'Purmont model', 'Northeast Guizhou', 'Guizhou overall model'];
export const vertexBytes = 20;

export class Models {
  #wasm;
  /** Of `bytes`, or a promise of a response. */
  static async start(source) {
    const bytes = await source;
    const { instance } = await WebAssembly.instantiate(bytes instanceof Response ? await bytes.arrayBuffer() : bytes, {});
    instance.exports._initialize?.();
    const models = new Models();
    models.#wasm = instance.exports;
    return models;
  }

  /** The paper's triangles of a model. */
  paperTriangles(number) {
    return this.#wasm.paper_triangles(number);
  }
  /** Plans a model, 1 to 5, of about so many triangles, a hundredth of the paper's unless said: how many meshes, vertices and
   * indices it will have, and each mesh's layer. */
  plan(number, triangles = this.paperTriangles(number) / 100, seed = 1) {
    const w = this.#wasm, count = w.plan(number, triangles, seed);
    const vertices = new Uint32Array(count), indices = new Uint32Array(count), layers = new Uint8Array(count);
    for (let piece = 0; piece < count; ++piece) {
      vertices[piece] = w.piece_vertices(piece), indices[piece] = w.piece_indices(piece), layers[piece] = w.piece_layer(piece);
    }
    const sum = (all) => all.reduce((a, b) => a + b, 0);
    return { number, count, vertices, indices, layers, triangles: sum(indices) / 3, vertexCount: sum(vertices), indexCount: sum(indices) };
  }
  /** Makes a mesh: views of the module's memory, until the next. */
  make(piece) {
    const w = this.#wasm;
    w.make_mesh(piece);
    return {
      vertices: new Uint8Array(w.memory.buffer, w.vertices(), vertexBytes * w.piece_vertices(piece)),
      indices: new Uint32Array(w.memory.buffer, w.indices(), w.piece_indices(piece)),
    };
  }
  /** Once all meshes are made: what centres them on the origin, and all boxes with it. */
  centre() {
    const w = this.#wasm, at = w.scratch(), boxes = w.centre(at);
    return { offset: Array.from(new Float32Array(w.memory.buffer, at, 3)),
      boxes: new Float32Array(w.memory.buffer, boxes, 6 * w.count()).slice() };
  }
}
