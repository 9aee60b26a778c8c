// Skeletons in 3D: a ball per joint, a rod per bone; reliable ones are large and bright.
import * as THREE from '/three/build/three.module.js';
import {BONES, JOINTS} from './skeleton.js';

const BALL = new THREE.SphereBufferGeometry(1, 12, 8);
const ROD = new THREE.CylinderBufferGeometry(1, 1, 1, 8);
const UP = new THREE.Vector3(0, 1, 0);
const OPACITY = {tracked: 1, inferred: 0.55, not_tracked: 0.25};

const materials = new Map();
function material(colour, opacity) {
  const key = colour + opacity;
  if (!materials.has(key)) {
    materials.set(key, new THREE.MeshBasicMaterial({color: colour, opacity, transparent: opacity < 1, depthWrite: opacity === 1}));
  }
  return materials.get(key);
}

const opacityOf = joint => OPACITY[joint.state] ?? 1;

export class Figures {
  // ball_m and rod_m: radii at reliability 1.
  constructor(ball_m, rod_m) {
    this.group = new THREE.Group();
    this.sizes = {ball_m, rod_m};
  }

  mesh(geometry) {
    const mesh = this.group.children[this.used] ?? new THREE.Mesh(geometry, null);
    if (!mesh.parent) this.group.add(mesh);
    mesh.geometry = geometry;
    mesh.visible = true;
    this.used += 1;
    return mesh;
  }

  ball(joint, colour) {
    const mesh = this.mesh(BALL);
    mesh.material = material(colour, opacityOf(joint));
    mesh.position.set(...joint.p);
    mesh.quaternion.set(0, 0, 0, 1);
    mesh.scale.setScalar(this.sizes.ball_m * (0.45 + 0.55 * (joint.reliability ?? 1)));
  }

  rod(from, to, colour) {
    const begin = new THREE.Vector3(...from.p), way = new THREE.Vector3(...to.p).sub(begin);
    const length = way.length();
    if (length < 1e-6) return;
    const mesh = this.mesh(ROD);
    mesh.material = material(colour, Math.min(opacityOf(from), opacityOf(to)));
    mesh.position.copy(begin).addScaledVector(way, 0.5);
    mesh.quaternion.setFromUnitVectors(UP, way.divideScalar(length));
    mesh.scale.set(this.sizes.rod_m, length, this.sizes.rod_m);
  }

  // bodies: [{id, joints}]; colourOf: of a body's id.
  show(bodies, colourOf) {
    this.used = 0;
    for (const {id, joints} of bodies) {
      const colour = colourOf(id);
      for (const name of JOINTS) if (joints[name]) this.ball(joints[name], colour);
      for (const [parent, child] of BONES) if (joints[parent] && joints[child]) this.rod(joints[parent], joints[child], colour);
    }
    for (const mesh of this.group.children.slice(this.used)) mesh.visible = false;
  }
}

const TRAILING = ['Head', 'HandLeft', 'HandRight', 'FootLeft', 'FootRight'];
const TRAIL_FRAMES = 45;  // a second and a half at 30 a second

// Recent paths of heads, hands and feet.
export class Trails {
  constructor() {
    this.group = new THREE.Group();
  }

  clear() {
    for (const line of this.group.children.splice(0)) line.geometry.dispose();
  }

  show(track, last, colourOf) {
    this.clear();
    for (const id of track.frames[last]?.bodies.keys() ?? []) {
      for (const name of TRAILING) this.trail(track, last, id, name, colourOf(id));
    }
  }

  trail(track, last, id, name, colour) {
    const points = [];
    for (let i = Math.max(0, last - TRAIL_FRAMES); i <= last; ++i) {
      const joint = track.joint(i, id, name);
      if (joint) points.push(new THREE.Vector3(...joint.p));
    }
    if (points.length < 2) return;
    const geometry = new THREE.BufferGeometry().setFromPoints(points);
    this.group.add(new THREE.Line(geometry, new THREE.LineBasicMaterial({color: colour, opacity: 0.7, transparent: true})));
  }
}
