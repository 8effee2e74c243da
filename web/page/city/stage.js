// A three.js canvas whose camera flies, which can be frozen for the culler while one looks on from elsewhere: the second and the
// third part share it.
import * as THREE from 'three';
import { SightlineCuller } from 'sightline-culling/three';
import { element, fit, isDark } from '../ui/elements.js';
import { Fly } from '../ui/fly.js';
import { direction } from '../ui/matrices.js';

const skies = { dark: ['#11161d', '#1c2530'], light: ['#d9e3ea', '#efe9dc'] };
const grounds = { dark: '#3a4038', light: '#b9b39c' };

export class Stage {
  constructor(label, { speed, far }) {
    this.canvas = element('canvas', { class: 'stage', ariaLabel: label });
    this.camera = new THREE.PerspectiveCamera(60, 16 / 9, 0.1, far);
    this.place = { eye: [0, 0, 0], heading: 0, tilt: 0 };
    this.depth = element('canvas', { class: 'depth', hidden: true, role: 'img', ariaLabel: 'The occluders’ depth' });
    this.flown = () => {};
    this.fly = new Fly(this.canvas, this.place, { speed, touched: () => this.flown() });
  }
  /** WebGL begins here; throws where there is none. */
  start() {
    try {
      this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true });
    } catch {
      throw new Error('This browser has no WebGL 2, which draws the scene.');
    }
  }
  show(scene, near = 0.1, far = 4000) {
    this.culler?.dispose();
    this.scene = scene;
    this.culler = new SightlineCuller(scene);
    this.frozen = undefined, (this.lens = undefined);
    this.camera.near = near, (this.camera.far = far), this.camera.updateProjectionMatrix();
  }
  /** Where the camera is, for who flies on from there. */
  takePlace() {
    const d = this.camera.getWorldDirection(new THREE.Vector3());
    this.place.eye.splice(0, 3, ...this.camera.position);
    this.place.heading = Math.atan2(-d.z, -d.x), (this.place.tilt = Math.asin(Math.max(-1, Math.min(1, d.y))));
  }
  usePlace() {
    const { eye, heading, tilt } = this.place, d = direction(heading, tilt);
    this.camera.position.set(...eye);
    this.camera.lookAt(eye[0] + d[0], eye[1] + d[1], eye[2] + d[2]);
  }
  /** Culls on for the view of now, whatever the camera does. */
  freeze(on) {
    if (this.lens) this.scene.remove(this.lens), this.lens.dispose();
    this.frozen = this.lens = undefined;
    if (on) {
      this.camera.updateMatrixWorld();
      this.frozen = this.camera.clone();
      const shown = this.frozen.clone();
      shown.far = Math.min(shown.far, 120), shown.updateProjectionMatrix();
      this.lens = new THREE.CameraHelper(shown);
      this.scene.add(this.lens);
    }
  }

  /** Draws; returns how many milliseconds render() kept the thread. */
  draw() {
    if (fit(this.canvas)) {
      this.renderer.setSize(this.canvas.width, this.canvas.height, false);
      this.camera.aspect = this.canvas.width / this.canvas.height, this.camera.updateProjectionMatrix();
    }
    const theme = isDark() ? 'dark' : 'light';
    if (theme !== this.theme || this.painted !== this.scene) this.#paint((this.theme = theme));
    this.culler.camera = this.frozen;
    const start = performance.now();
    this.renderer.render(this.scene, this.camera);
    return performance.now() - start;
  }
  /** The same, and waits until it is drawn. */
  drawWhole() {
    const { renderer } = this, gl = renderer.getContext(), start = performance.now();
    const thread = this.draw();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return { thread, whole: performance.now() - start };
  }
  #paint(theme) {
    const [sky, haze] = skies[theme];
    this.scene.background = new THREE.Color(sky).lerp(new THREE.Color(haze), 0.6);
    if (this.scene.fog) this.scene.fog.color.copy(this.scene.background);
    this.ground?.color.set(grounds[theme]);
    this.painted = this.scene;
  }

  /** Paints the occluders' depth that the last frame drew. */
  showDepth() {
    const depth = this.culler.readDepth(), { canvas } = { canvas: this.depth };
    if (!depth) return canvas.getContext('2d').clearRect(0, 0, canvas.width, canvas.height);
    const { width, height, nearness } = depth, picture = new ImageData(width, height);
    for (let p = 0; p < nearness.length; ++p) {
      const near = nearness[p], share = near > 0 ? Math.min(1, Math.max(0, 1 + Math.log10(near * 2) / 3)) : 0;
      picture.data.set(near > 0 ? [40 + 215 * share, 60 + 130 * share, 100 - 40 * share, 255] : [18, 22, 28, 255], 4 * p);
    }
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    canvas.getContext('2d').putImageData(picture, 0, 0);
  }
}
