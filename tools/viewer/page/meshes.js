// Fitted bodies: the skin of each, in the colour of its person.
import * as THREE from '/three/build/three.module.js';
import {personColour} from './colours.js';

// Vertex indices of the triangles, the same for all bodies; empty where ossa shows no bodies.
async function loadTriangles() {
  const answer = await fetch('/mesh');
  return new Uint32Array(await answer.arrayBuffer());
}

export class Meshes {
  // onReady: called once the triangles are there.
  constructor(onReady) {
    this.group = new THREE.Group();
    loadTriangles().then(triangles => {
      this.triangles = new THREE.BufferAttribute(triangles, 1);
      onReady();
    });
  }

  mesh(k) {
    const known = this.group.children[k];
    if (known) return known;
    const mesh = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial());
    mesh.geometry.setIndex(this.triangles);
    mesh.frustumCulled = false;
    this.group.add(mesh);
    return mesh;
  }

  // meshes: [{id, corners: Float32Array of x, y, z}]
  show(meshes) {
    for (const mesh of this.group.children) mesh.visible = false;
    if (!this.triangles) return;
    meshes.forEach(({id, corners}, k) => {
      const mesh = this.mesh(k);
      mesh.visible = true;
      mesh.material.color.set(personColour(id));
      mesh.geometry.setAttribute('position', new THREE.BufferAttribute(corners, 3));
      mesh.geometry.computeVertexNormals();
    });
  }
}
