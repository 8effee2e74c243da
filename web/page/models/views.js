// The views of the models: the paper's, those around it, from above, and a path that was flown.
import { clipZeroToOne } from 'sightline-culling';
import { direction, lookAlong, orthographic, perspective } from '../ui/matrices.js';

const fov = 0.8, near = 10, far = 1e5;
/** V: 40 km from the middle, level (section 4). */
export const paperViewpoint = () => ({ eye: [40000, 0, 0], heading: 0, tilt: 0 });

const view = (eye, worldToEye, projection, width, height) =>
  ({ eye, worldToEye, projection, width, height, eyeToClip: clipZeroToOne(projection) });

/** What a place sees. */
export const viewOf = ({ eye, heading, tilt }, width, height) =>
  view(eye, lookAlong(eye, direction(heading, tilt)), perspective(fov, width / height, near, far), width, height);

/** At V's distance, so many degrees aside and above, towards the middle. */
export function placeAround(aside, above, distance = 40000) {
  const a = (aside * Math.PI) / 180, b = (above * Math.PI) / 180;
  return { eye: [distance * Math.cos(b) * Math.cos(a), distance * Math.sin(b), distance * Math.cos(b) * Math.sin(a)], heading: a, tilt: -b };
}

/** All of the ground from above, V beyond the lower edge. */
export function viewFromAbove(boxes, width, height) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  boxes.forEach((x, i) => {
    if (i % 6 < 3) low[i % 6] = Math.min(low[i % 6], x);
    else high[i % 6 - 3] = Math.max(high[i % 6 - 3], x);
  });
  const eye = [0, high[1] + 1000, 0], tall = 1.05 * Math.max(high[0] - low[0], ((high[2] - low[2]) * height) / width);
  return view(eye, lookAlong(eye, [0, -1, 0], [-1, 0, 0]), orthographic(tall, width / height, near, high[1] - low[1] + 2000), width, height);
}

// Eyes one after another, and what each looks at; it begins at V and comes back.
const recorded = [
  [[40000, 0, 0], [0, 0, 0]], [[30000, 7000, 10000], [0, -1000, 0]], [[16000, 9500, 17000], [-1000, 0, 0]],
  [[2000, 9000, 17000], [-2000, 1000, -3000]], [[-11000, 8500, 11500], [0, 0, -4000]], [[-15000, 9500, -2000], [4000, 0, -2000]],
  [[-9000, 13000, -13000], [3000, -1000, 0]], [[6000, 15000, -17000], [2000, -2000, 0]], [[21000, 12000, -14000], [0, -2000, 0]],
  [[35000, 5000, -8000], [0, -500, 0]]];

// Through four points, between the second and the third (Catmull & Rom 1974).
const between = (a, b, c, d, t) => a.map((_, k) => 0.5 * (2 * b[k] + (c[k] - a[k]) * t + (2 * a[k] - 5 * b[k] + 4 * c[k] - d[k]) * t * t +
  (3 * b[k] - a[k] - 3 * c[k] + d[k]) * t * t * t));

/** Where the path is at a share of its length, 0 to 1. */
export function placeOnPath(share) {
  const n = recorded.length, at = (((share % 1) + 1) % 1) * n, k = Math.floor(at), four = [-1, 0, 1, 2].map((i) => recorded[(k + i + n) % n]);
  const [eye, towards] = [0, 1].map((which) => between(...four.map((point) => point[which]), at - k));
  const d = towards.map((x, i) => x - eye[i]);
  return { eye, heading: Math.atan2(-d[2], -d[0]), tilt: Math.atan2(d[1], Math.hypot(d[0], d[2])) };
}
