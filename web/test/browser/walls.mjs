// What hides, and what is hidden behind it.
import * as THREE from 'three';
import { basic, box } from './play.mjs';

/** A wall before the eye, and a hundred boxes behind it; returns the wall. */
export function walled(scene, material = basic(0x808080)) {
  const wall = new THREE.Mesh(new THREE.BoxGeometry(20, 10, 1), material);
  wall.position.z = -10, scene.add(wall);
  for (let i = 0; i < 100; ++i) scene.add(box((i % 10) - 5, Math.floor(i / 10) - 5, -20, (i * 1234567) & 0xffffff, 0.6));
  return wall;
}
