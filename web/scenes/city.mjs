// A city for three.js: houses, and small things in the streets between them, each of a colour of its own, as separate
// meshes, instances or a batch; some move.
import * as THREE from 'three';

// splitmix32, so that cities and views are the same everywhere.
export function random(seed) {
  return () => {
    seed = (seed + 0x9e3779b9) | 0;
    let z = Math.imul(seed ^ (seed >>> 16), 0x21f0aaad);
    z = Math.imul(z ^ (z >>> 15), 0x735a2d97);
    return ((z ^ (z >>> 15)) >>> 0) / 2 ** 32;
  };
}

const block = 24, house = 18;

/** Where things stand: a tenth are houses. */
export function places(count, seed = 1) {
  const next = random(seed), side = Math.ceil(Math.sqrt(count / 10)), all = [];
  for (let i = 0; i < count; ++i) {
    const isHouse = i < side * side && i * 10 <= count + 10 * side * side;
    const column = i % side, row = Math.floor(i / side) % side;
    if (isHouse) {
      const height = 8 + 40 * next();
      all.push({ at: [column * block, height / 2, row * block], size: [house, height, house], turn: 0 });
    } else {
      const size = [0.3 + next(), 0.3 + 2 * next(), 0.3 + next()];
      all.push({ at: [(next() * side - 0.5) * block, size[1] / 2, (next() * side - 0.5) * block], size, turn: 6.3 * next() });
    }
  }
  return { all, side: side * block };
}

const boxes = () => new THREE.BoxGeometry(1, 1, 1);
const cones = () => new THREE.ConeGeometry(0.5, 1, 7);
// A colour a thing, exact in 8 bits and without colour management.
const colourOf = (i) => new THREE.Color().setRGB(((i * 7 + 1) & 255) / 255, ((i >> 5) & 255) / 255, ((i * 3) & 255) / 255,
  THREE.LinearSRGBColorSpace);

export function matrixOf({ at, size, turn }) {
  return new THREE.Matrix4().compose(new THREE.Vector3(...at), new THREE.Quaternion().setFromAxisAngle(
    new THREE.Vector3(0, 1, 0), turn), new THREE.Vector3(...size));
}

/** Adds things as `kind`; returns what moves thing i to a place. */
export function add(scene, kind, all, material, first = 0) {
  if (kind === 'instanced') {
    const mesh = new THREE.InstancedMesh(boxes(), material.clone(), all.length);
    all.forEach((place, i) => (mesh.setMatrixAt(i, matrixOf(place)), mesh.setColorAt(i, colourOf(first + i))));
    scene.add(mesh);
    return (i, place) => (mesh.setMatrixAt(i, matrixOf(place)), (mesh.instanceMatrix.needsUpdate = true));
  }
  if (kind === 'batched') {
    const batch = new THREE.BatchedMesh(all.length, 200, 600, material.clone());
    const shapes = [batch.addGeometry(boxes()), batch.addGeometry(cones())];
    all.forEach((place, i) => {
      const id = batch.addInstance(shapes[place.turn === 0 ? 0 : i % 2]);
      batch.setMatrixAt(id, matrixOf(place)), batch.setColorAt(id, colourOf(first + i));
    });
    scene.add(batch);
    return (i, place) => batch.setMatrixAt(i, matrixOf(place));
  }
  const shapes = [boxes(), cones()], group = new THREE.Group();
  const meshes = all.map((place, i) => {
    const own = material.clone();
    own.color.copy(colourOf(first + i));
    const mesh = new THREE.Mesh(shapes[place.turn === 0 ? 0 : i % 2], own);
    matrixOf(place).decompose(mesh.position, mesh.quaternion, mesh.scale);
    mesh.castShadow = mesh.receiveShadow = true;
    group.add(mesh);
    return mesh;
  });
  scene.add(group);
  return (i, place) => matrixOf(place).decompose(meshes[i].position, meshes[i].quaternion, meshes[i].scale);
}

/** A camera at street level, or above. */
export function look(camera, next, side, height = 1.6) {
  camera.position.set((Math.floor(next() * side / block) + 0.5) * block, height * (0.5 + next()), next() * side);
  camera.rotation.set((next() - 0.5) * 0.3, next() * 6.3, 0, 'YXZ');
}
