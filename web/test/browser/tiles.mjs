// In the page: a tile set of a street behind a wall, which a plug-in makes on the spot, with and without SightlineTilesPlugin.
import { TilesRenderer } from '3d-tiles-renderer/three';
import * as THREE from 'three';
import { ready, SightlineTilesPlugin } from 'sightline-culling/three-tiles';

THREE.ColorManagement.enabled = false;
const width = 320, height = 180;

// Boxes: a wall at z = -10, 20 m wide, and behind it and beside it a quadtree of ground that goes up in blocks.
const box = ([x0, y0, z0, x1, y1, z1]) => ({ box: [(x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2, (x1 - x0) / 2, 0, 0, 0, (y1 - y0) / 2, 0, 0, 0, (z1 - z0) / 2] });
const leaf = (bounds, level) => ({ boundingVolume: box(bounds), geometricError: level === 0 ? 0 : 4 * 2 ** level, refine: 'REPLACE',
  content: { uri: `${bounds.map((x) => x.toFixed(3)).join('_')}.blocks` } });
function quarter([x0, y0, z0, x1, y1, z1], level) {
  const tile = leaf([x0, y0, z0, x1, y1, z1], level);
  if (level === 0) return tile;
  const x = (x0 + x1) / 2, z = (z0 + z1) / 2;
  tile.children = [[x0, z0, x, z], [x, z0, x1, z], [x0, z, x, z1], [x, z, x1, z1]].map(([a, b, c, d]) => quarter([a, y0, b, c, y1, d], level - 1));
  return tile;
}
const tileset = () => ({ asset: { version: '1.0' }, geometricError: 1e6, root: {
  boundingVolume: box([-100, 0, -210, 100, 12, 0]), geometricError: 1e6, refine: 'ADD',
  children: [leaf([-10, 0, -11, 10, 12, -10], 0), quarter([-80, 0, -180, 80, 4, -20], 4)] } });

/** Serves and makes tiles, and counts them. */
class Made {
  name = 'MADE';
  asked = new Set();
  fetchData(url) {
    if (url.endsWith('.json')) return Promise.resolve(tileset());
    this.asked.add(url);
    return Promise.resolve(new Response(new Uint8Array(8)));
  }
  parseToMesh(_, tile) {
    const [cx, cy, cz, hx, , , , hy, , , , hz] = tile.boundingVolume.box;
    const mesh = new THREE.Mesh(new THREE.BoxGeometry(2 * hx, 2 * hy, 2 * hz).translate(cx, cy, cz),
      new THREE.MeshBasicMaterial({ color: new THREE.Color().setRGB(((cx * 37) & 255) / 255, (Math.abs(cz * 91) & 255) / 255, (hx * 9 & 255) / 255) }));
    return Promise.resolve(new THREE.Group().add(mesh));
  }
}

async function draw(renderer, culls, eye, siblings) {
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(60, width / height, 0.1, 1000);
  scene.background = new THREE.Color(0x203040);
  camera.position.set(...eye), camera.updateMatrixWorld();
  const made = new Made(), tiles = new TilesRenderer('https://tiles.invalid/tileset.json'), plugin = new SightlineTilesPlugin();
  tiles.registerPlugin(made);
  if (culls) tiles.registerPlugin(plugin);
  tiles.loadSiblings = tiles.loadAncestors = siblings;
  // A tile's own up is +z unless its glTF says otherwise; these are made upright.
  tiles.errorTarget = 1;
  tiles.setCamera(camera), tiles.setResolution(camera, width, height);
  scene.add(tiles.group);
  let still = 0, before = -1;
  for (let round = 0; round < 400 && still < 12; ++round) {
    scene.updateMatrixWorld(), tiles.update();
    await new Promise((resolve) => requestAnimationFrame(resolve));
    const now = made.asked.size + 1000 * tiles.visibleTiles.size + (tiles.isLoading ? 1e7 : 0);
    still = now === before && !tiles.isLoading ? still + 1 : 0, (before = now);
  }
  renderer.render(scene, camera);
  const gl = renderer.getContext(), pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const result = { pixels, asked: made.asked.size, shown: tiles.visibleTiles.size, ...plugin.stats };
  tiles.dispose(), plugin.dispose();
  return result;
}

window.compare = async () => {
  await ready;
  const renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace, renderer.setSize(width, height);
  const views = [];
  for (const [eye, siblings] of [[[0, 2, 0], false], [[0, 2, 0], true], [[0, 2, -7], false], [[0, 40, 60], false]]) {
    const without = await draw(renderer, false, eye, siblings), culled = await draw(renderer, true, eye, siblings);
    let differing = 0;
    for (let i = 0; i < without.pixels.length; ++i) if (without.pixels[i] !== culled.pixels[i]) ++differing;
    views.push({ eye, differing, asked: [without.asked, culled.asked], shown: [without.shown, culled.shown], hidden: culled.hidden, occluders: culled.occluders,
      colours: new Set(new Uint32Array(culled.pixels.buffer)).size });
  }
  renderer.dispose(), renderer.forceContextLoss();
  return views;
};
