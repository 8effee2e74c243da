// Flies a camera: keys (W A S D or arrows, Q and E down and up, Shift faster), dragging, the wheel, one finger to look and two to move.
import { direction } from './matrices.js';

const keys = { KeyW: [0, 0, 1], ArrowUp: [0, 0, 1], KeyS: [0, 0, -1], ArrowDown: [0, 0, -1], KeyA: [-1, 0, 0], ArrowLeft: [-1, 0, 0],
  KeyD: [1, 0, 0], ArrowRight: [1, 0, 0], KeyE: [0, 1, 0], KeyQ: [0, -1, 0] };

export class Fly {
  /** `place` has `eye`, `heading` and `tilt`; `speed` is metres a second; `touched` hears that somebody flies. */
  constructor(canvas, place, { speed, touched = () => {} }) {
    this.place = place, (this.speed = speed);
    this.down = new Set(), (this.pointers = new Map());
    canvas.tabIndex = 0;
    canvas.addEventListener('keydown', (event) => {
      if (!(event.code in keys) || event.ctrlKey || event.metaKey || event.altKey) return;
      this.down.add(event.code), (this.fast = event.shiftKey), touched();
      event.preventDefault();
    });
    canvas.addEventListener('keyup', (event) => (this.down.delete(event.code), (this.fast = event.shiftKey)));
    canvas.addEventListener('blur', () => this.down.clear());
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault(), touched();
      this.#move([0, 0, -Math.sign(event.deltaY) * 0.12]);
    }, { passive: false });
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId), canvas.focus({ preventScroll: true });
      this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    const up = (event) => this.pointers.delete(event.pointerId);
    canvas.addEventListener('pointerup', up), canvas.addEventListener('pointercancel', up);
    canvas.addEventListener('pointermove', (event) => this.#drag(event, canvas, touched));
  }

  /** Moves on by some seconds; whether anything moved. */
  step(seconds) {
    if (this.down.size === 0) return false;
    const sum = [0, 0, 0];
    for (const code of this.down) keys[code].forEach((x, axis) => (sum[axis] += x));
    this.#move(sum.map((x) => x * seconds * (this.fast ? 4 : 1)));
    return true;
  }

  #drag(event, canvas, touched) {
    const from = this.pointers.get(event.pointerId);
    if (!from) return;
    const dx = event.clientX - from[0], dy = event.clientY - from[1], scale = 1.6 / canvas.clientHeight;
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    touched();
    if (this.pointers.size > 1) return this.#move([-dx * scale * 0.6, 0, -dy * scale]);
    this.place.heading -= dx * scale;
    this.place.tilt = Math.max(-1.55, Math.min(1.55, this.place.tilt + dy * scale));
  }

  #move([right, up, forward]) {
    const { eye, heading, tilt } = this.place, ahead = direction(heading, tilt);
    const side = [Math.sin(heading), 0, -Math.cos(heading)];
    for (let axis = 0; axis < 3; ++axis)
      eye[axis] += this.speed * (forward * ahead[axis] + right * side[axis] + (axis === 1 ? up : 0));
  }
}
