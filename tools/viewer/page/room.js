// The floor with its metre grid, and the camera with what it sees.
import * as THREE from '/three/build/three.module.js';

const FLOOR_M = 12;  // edge of the grid
const REACH_M = 4.5;  // of the frustum that is drawn

export function makeFloor() {
  const grid = new THREE.GridHelper(FLOOR_M, FLOOR_M, 0x6b7686, 0x3a4250);
  grid.position.set(0, 0, FLOOR_M / 2 - 1);
  return grid;
}

// Light for surfaces: from above, and some from the camera's side.
export function addLight(scene) {
  const sun = new THREE.DirectionalLight(0xffffff, 0.6);
  sun.position.set(-1, 2, -2);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x555560, 0.6), sun);
}

// Corners of the image at a distance, in camera space.
function corners(camera, z) {
  const place = (u, v) => new THREE.Vector3((camera.cx - u) * z / camera.fx, (camera.cy - v) * z / camera.fy, z);
  return [place(0, 0), place(camera.width, 0), place(camera.width, camera.height), place(0, camera.height)];
}

export class Frustum {
  constructor() {
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({color: 0x7d8a9c}));
    this.lines.frustumCulled = false;
  }

  show(camera) {
    const key = JSON.stringify(camera);
    if (key === this.key) return;
    this.key = key;
    const far = corners(camera, REACH_M), eye = new THREE.Vector3();
    const points = far.flatMap((corner, i) => [eye, corner, corner, far[(i + 1) % 4]]);
    this.lines.geometry.dispose();
    this.lines.geometry = new THREE.BufferGeometry().setFromPoints(points);
  }
}
