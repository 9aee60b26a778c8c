// The 20 joints in the order of the Kinect SDK, and the 19 bones between them.
export const JOINTS = [
  'HipCenter', 'Spine', 'ShoulderCenter', 'Head', 'ShoulderLeft', 'ElbowLeft', 'WristLeft', 'HandLeft', 'ShoulderRight',
  'ElbowRight', 'WristRight', 'HandRight', 'HipLeft', 'KneeLeft', 'AnkleLeft', 'FootLeft', 'HipRight', 'KneeRight',
  'AnkleRight', 'FootRight',
];
const PARENTS = [-1, 0, 1, 2, 2, 4, 5, 6, 2, 8, 9, 10, 0, 12, 13, 14, 0, 16, 17, 18];
// [parent, child] by name.
export const BONES = JOINTS.map((name, j) => [JOINTS[PARENTS[j]], name]).slice(1);

export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

// Degrees between the bones that meet in `at`; 180 is stretched.
export function angle(from, at, to) {
  const a = from.map((x, i) => x - at[i]), b = to.map((x, i) => x - at[i]);
  const cosine = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / (Math.hypot(...a) * Math.hypot(...b));
  return Math.acos(Math.max(-1, Math.min(1, cosine))) * 180 / Math.PI;
}

// Pixel of a point in camera space (x to the left, y up, z forward, metres).
export const project = (camera, p) => [camera.cx - camera.fx * p[0] / p[2], camera.cy - camera.fy * p[1] / p[2]];
