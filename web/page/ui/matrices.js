// Column-major matrices of 16 numbers, and cameras made of them.

export function multiply(a, b) {
  const out = new Float32Array(16);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += a[4 * k + row] * b[4 * column + k];
      out[4 * column + row] = sum;
    }
  }
  return out;
}
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = (a) => {
  const length = Math.hypot(...a);
  return a.map((x) => x / length);
};

/** From `eye` along `forward`, `up` above. */
export function lookAlong(eye, forward, up = [0, 1, 0]) {
  const back = unit(forward.map((x) => -x)), right = unit(cross(up, back)), above = cross(back, right);
  return [right[0], above[0], back[0], 0, right[1], above[1], back[1], 0, right[2], above[2], back[2], 0,
    -dot(right, eye), -dot(above, eye), -dot(back, eye), 1];
}
/** With WebGL's depth, -1 to 1. */
export function perspective(fov, aspect, near, far) {
  const f = 1 / Math.tan(fov / 2);
  return [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
}
export function orthographic(height, aspect, near, far) {
  return [2 / (height * aspect), 0, 0, 0, 0, 2 / height, 0, 0, 0, 0, 2 / (near - far), 0, 0, 0, (far + near) / (near - far), 1];
}
/** The direction of a heading and a tilt, in radians; 0, 0 looks along -x, as the paper's viewpoint does. */
export const direction = (heading, tilt) =>
  [-Math.cos(tilt) * Math.cos(heading), Math.sin(tilt), -Math.cos(tilt) * Math.sin(heading)];
