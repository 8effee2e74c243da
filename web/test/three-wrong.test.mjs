// What users set wrongly: it is refused, or said, or that one thing is drawn as without the culler, and all else is culled.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { SightlineError } from 'sightline-culling';
import { ready, SightlineCuller } from 'sightline-culling/three';
import { SightlineTilesPlugin } from 'sightline-culling/three-tiles';

const solid = new THREE.MeshBasicMaterial();
const meshAt = (z, size = 1, material = solid) => {
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(size, size, size), material);
  return (mesh.position.z = z), mesh;
};

// What is drawn of something odd, of what lies behind it, and of what lies behind the eye; and what was said of it all.
async function draw(t, spoil, set = {}) {
  await ready;
  const { mock } = t.mock.method(console, 'warn', () => {});
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(60, 1, 0.1, 1000), culler = new SightlineCuller(scene);
  const odd = meshAt(-5, 2), hidden = meshAt(-20), behind = meshAt(50);
  odd.name = 'odd', scene.add(behind), Object.assign(culler, set);
  let drawn;
  for (let frame = 0; frame < 3; ++frame) {
    scene.updateMatrixWorld(), scene.onBeforeRender({ isWebGLRenderer: true, sortObjects: true }, scene, camera, null);
    drawn = [odd, hidden, behind].map((mesh) => scene.children.includes(mesh));
    scene.onAfterRender();
    if (frame === 0) spoil(odd), scene.add(odd, hidden);
  }
  culler.dispose();
  const said = mock.calls.map(({ arguments: [sentence] }) => sentence);
  return mock.restore(), { drawn, said };
}

test('an odd object is drawn and hides nothing, and all else is culled on', async (t) => {
  const odd = { holes: (mesh) => (mesh.material = [solid, undefined]), gaps: (mesh) => (mesh.material = [solid, , solid]) };
  for (const [name, spoil] of Object.entries(odd)) {
    const marked = (mesh) => (spoil(mesh), (mesh.userData.occluder = true));
    for (const how of [spoil, marked]) assert.deepEqual(await draw(t, how), { drawn: [true, true, false], said: [] }, name);
  }
  const none = (mesh) => (mesh.userData = null); // which is no mark, either
  assert.deepEqual(await draw(t, none), { drawn: [true, false, false], said: [] });
});

test('a mark that is none is told of once, and the object hides nothing', async (t) => {
  for (const mark of [{}, meshAt(0), new THREE.BufferGeometry(), 5, 'x', { attributes: { position: 1 } }]) {
    const { drawn, said } = await draw(t, (mesh) => (mesh.userData.occluder = mark));
    assert.deepEqual(drawn, [true, true, false]);
    assert.equal(said.length, 1);
    assert.match(said[0], /Mesh "odd" .*userData\.occluder is .*, expected true, false or a closed convex BufferGeometry$/);
  }
});

test('a camera that is none is told of once, and the one that draws is culled for', async (t) => {
  const { drawn, said } = await draw(t, () => {}, { camera: 5 });
  assert.deepEqual([drawn, said.length], [[true, false, false], 1]);
  assert.match(said[0], /culler\.camera is 5, expected a Camera/);
});

test('options of other names and kinds are refused, and init() without a renderer', () => {
  const refused = (call, expected) => assert.throws(call, (error) => error instanceof SightlineError && expected.test(error.message));
  const make = (options) => () => new SightlineCuller(new THREE.Scene(), options);
  refused(make({ oclusion: false }), /SightlineCuller: oclusion is no option, expected an object of occlusion, bufferWidth/);
  for (const options of [512, 'x', () => 1]) refused(make(options), /SightlineCuller: .* is no option, expected an object of occlusion/);
  for (const occlusion of ['no', 1, null]) refused(make({ occlusion }), /an occlusion of (no|1|null), expected true or false/);
  for (const options of [undefined, null, {}, { occlusion: undefined }]) make(options)().dispose();
  refused(() => new SightlineTilesPlugin(60_000), /SightlineTilesPlugin: 60000 is no option, expected an object of mostTriangles/);
  refused(() => new SightlineTilesPlugin({ triangles: 1 }), /triangles is no option, expected an object of mostTriangles/);
  const plugin = new SightlineTilesPlugin();
  for (const tiles of [undefined, null, {}, 5, new THREE.Group()]) refused(() => plugin.init(tiles), /expected registerPlugin\(\)/);
  plugin.dispose();
});
