// A city of things that stand and things that turn, as instances, a batch, or meshes of their own.
import * as THREE from 'three';
import { matrixOf, places, random } from '../../scenes/city.mjs';

const walls = ['#d9c7ae', '#c9a27e', '#b8bec6', '#e4ddd0', '#a9988a', '#8fa3ad', '#cfb08f'];
const goods = ['#e0703c', '#e8b04a', '#4f9d8f', '#3f7cac', '#c4546a', '#7a8b4a', '#f0e2c4'];

function colourOf(place, next) {
  const all = place.turn === 0 ? walls : goods;
  return new THREE.Color(all[Math.floor(next() * all.length)]).offsetHSL(0, 0, (next() - 0.5) * 0.08);
}

export class City {
  /** `kind`: instanced, batched or meshes. */
  constructor(count, kind) {
    const { all, side } = places(count), next = random(5), colours = all.map((place) => colourOf(place, next));
    this.side = side, (this.all = all), (this.kind = kind);
    this.scene = new THREE.Scene();
    const sun = new THREE.DirectionalLight('#ffe9c8', 2.4);
    sun.position.set(0.55, 0.75, 0.4);
    const ground = new THREE.Mesh(new THREE.PlaneGeometry(3 * side + 4000, 3 * side + 4000).rotateX(-Math.PI / 2).translate(side / 2, -0.02, side / 2),
      this.ground = new THREE.MeshLambertMaterial());
    ground.userData.occluder = false;
    this.scene.add(sun, new THREE.HemisphereLight('#eef3fa', '#b5a184', 2.3), ground);
    this.moving = all.flatMap((place, i) => (place.turn === 0 ? [] : [i]));
    this.move = this[`add_${kind}`](all, colours);
    this.at = 0;
  }
  /** Another share of the things turns; called once a frame. */
  turn(share, time) {
    const some = Math.floor(this.moving.length * share);
    for (let k = 0; k < some; ++k) {
      const i = this.moving[(this.at + k) % this.moving.length], place = this.all[i];
      this.move(i, { ...place, turn: place.turn + time });
    }
    if (this.moving.length > 0) this.at = (this.at + some) % this.moving.length;
    return some;
  }
  /** Whether three itself culls. */
  set threeCulls(on) {
    for (const mesh of this.culled) {
      mesh.frustumCulled = on;
      if (mesh.isBatchedMesh) mesh.perObjectFrustumCulled = on;
    }
  }
  dispose() {
    for (const mesh of this.culled) mesh.geometry.dispose(), mesh.material.dispose(), mesh.dispose?.();
  }

  add_instanced(all, colours) {
    const mesh = new THREE.InstancedMesh(new THREE.BoxGeometry(), new THREE.MeshLambertMaterial(), all.length);
    all.forEach((place, i) => (mesh.setMatrixAt(i, matrixOf(place)), mesh.setColorAt(i, colours[i])));
    this.scene.add(mesh), (this.culled = [mesh]);
    return (i, place) => (mesh.setMatrixAt(i, matrixOf(place)), (mesh.instanceMatrix.needsUpdate = true));
  }
  add_batched(all, colours) {
    const batch = new THREE.BatchedMesh(all.length, 400, 1200, new THREE.MeshLambertMaterial());
    const shapes = [new THREE.BoxGeometry(), new THREE.ConeGeometry(0.5, 1, 9), new THREE.CylinderGeometry(0.5, 0.5, 1, 10)].map((each) => batch.addGeometry(each));
    all.forEach((place, i) => {
      const id = batch.addInstance(shapes[place.turn === 0 ? 0 : i % 3]);
      batch.setMatrixAt(id, matrixOf(place)), batch.setColorAt(id, colours[i]);
    });
    this.scene.add(batch), (this.culled = [batch]);
    return (i, place) => batch.setMatrixAt(i, matrixOf(place));
  }
  add_meshes(all, colours) {
    const shapes = [new THREE.BoxGeometry(), new THREE.ConeGeometry(0.5, 1, 9), new THREE.CylinderGeometry(0.5, 0.5, 1, 10)], paints = new Map();
    this.culled = all.map((place, i) => {
      const name = colours[i].getHexString();
      if (!paints.has(name)) paints.set(name, new THREE.MeshLambertMaterial({ color: colours[i] }));
      const mesh = new THREE.Mesh(shapes[place.turn === 0 ? 0 : i % 3], paints.get(name));
      matrixOf(place).decompose(mesh.position, mesh.quaternion, mesh.scale);
      this.scene.add(mesh);
      return mesh;
    });
    return (i, place) => this.culled[i].quaternion.setFromAxisAngle(up, place.turn);
  }
}
const up = new THREE.Vector3(0, 1, 0);

/** Along the streets at eye level, and round the corners. */
export function walk(camera, side, seconds) {
  const block = 24, length = Math.max(2, Math.floor(side / block) - 1), speed = 6, leg = (length * block) / speed, t = seconds / leg;
  const turn = Math.floor(t) % 4, s = Math.min(1, (t % 1) * 1.0), low = 0.5 * block, high = low + length * block;
  const corners = [[low, low], [high, low], [high, high], [low, high], [low, low]];
  const [a, b] = [corners[turn], corners[turn + 1]];
  camera.position.set(a[0] + (b[0] - a[0]) * s, 2.2 + 0.6 * Math.sin(seconds / 3), a[1] + (b[1] - a[1]) * s);
  const heading = Math.atan2(b[1] - a[1], b[0] - a[0]), glance = 0.35 * Math.sin(seconds / 2.3);
  camera.lookAt(camera.position.x + Math.cos(heading + glance), camera.position.y + 0.06, camera.position.z + Math.sin(heading + glance));
}
