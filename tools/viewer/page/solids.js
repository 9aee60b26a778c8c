// Solids of the physical world: boxes, balls, capsules; those of a character in the colour of its person.
import * as THREE from '/three/build/three.module.js';
import {THINGS, personColour} from './colours.js';

const BOX = new THREE.BoxBufferGeometry(1, 1, 1);
const BALL = new THREE.SphereBufferGeometry(0.5, 20, 14);
const TUBE = new THREE.CylinderBufferGeometry(0.5, 0.5, 1, 20, 1, true);

export class Solids {
  constructor() {
    this.group = new THREE.Group();
    this.materials = new Map();
  }

  material(colour) {
    if (!this.materials.has(colour)) {
      this.materials.set(colour, new THREE.MeshLambertMaterial({color: colour, opacity: 0.75, transparent: true}));
    }
    return this.materials.get(colour);
  }

  // One of the meshes, of all kinds: at a place, as large as `size`, moved along its own y by `along`.
  put(geometry, solid, size, along = 0) {
    const mesh = this.group.children[this.used] ?? new THREE.Mesh(geometry, null);
    if (!mesh.parent) this.group.add(mesh);
    this.used += 1;
    mesh.visible = true;
    mesh.geometry = geometry;
    mesh.material = this.material(solid.person ? personColour(solid.person) : THINGS);
    mesh.quaternion.set(...solid.turn);
    mesh.position.set(0, along, 0).applyQuaternion(mesh.quaternion).add(new THREE.Vector3(...solid.at));
    mesh.scale.set(...size);
  }

  // size: a box's edges; of a ball x is the diameter; of a capsule also, y the way between its ends' centres.
  add(solid) {
    const [x, y] = solid.size;
    if (solid.shape === 'box') return this.put(BOX, solid, solid.size);
    if (solid.shape === 'ball') return this.put(BALL, solid, [x, x, x]);
    this.put(TUBE, solid, [x, y, x]);
    for (const end of [-y / 2, y / 2]) this.put(BALL, solid, [x, x, x], end);
  }

  show(solids) {
    this.used = 0;
    for (const solid of solids) this.add(solid);
    for (const mesh of this.group.children.slice(this.used)) mesh.visible = false;
  }
}
