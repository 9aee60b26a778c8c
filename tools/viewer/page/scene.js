// The 3D view: the world with the floor at y = 0, its content, and the view point.
import * as THREE from '/three/build/three.module.js';
import {OrbitControls} from '/three/examples/jsm/controls/OrbitControls.js';
import {Cloud} from './cloud.js';
import {LAYERS, OVERLAYS, personColour} from './colours.js';
import {Figures, Trails} from './figures.js';
import {Meshes} from './meshes.js';
import {Frustum, addLight, makeFloor} from './room.js';
import {Solids} from './solids.js';

const UP = new THREE.Vector3(0, 1, 0);
const EYE_HEIGHT_M = 1;  // of a camera that sees no floor
const FIELD = 50;  // degrees, of all views but the camera's own

export class Scene {
  constructor(canvas, labels) {
    this.canvas = canvas;
    this.labels = labels;
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.scene = new THREE.Scene();
    this.world = new THREE.Group();  // camera space, standing on the floor
    this.scene.add(this.world);
    this.front = new THREE.Scene();  // skeletons, drawn over the points that hide them
    this.frontWorld = new THREE.Group();
    this.front.add(this.frontWorld);
    this.renderer.autoClear = false;
    this.eye = new THREE.PerspectiveCamera(FIELD, 1, 0.05, 60);
    this.controls = new OrbitControls(this.eye, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.addContent();
    this.setView('orbit');
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  addContent() {
    this.cloud = new Cloud();
    this.frustum = new Frustum();
    this.trails = new Trails();
    this.floor = makeFloor();
    this.figures = {final: new Figures(0.035, 0.014), refined: new Figures(0.022, 0.006), raw: new Figures(0.026, 0.003)};
    this.meshes = new Meshes(() => this.showMeshes());
    this.solids = new Solids();
    this.overlays = [];
    addLight(this.scene);
    this.scene.add(this.floor);
    this.world.add(this.cloud.points, this.frustum.lines, this.meshes.group, this.solids.group);
    this.frontWorld.add(this.trails.group);
    for (const figures of Object.values(this.figures)) this.frontWorld.add(figures.group);
    this.layers = {cloud: this.cloud.points, frustum: this.frustum.lines, trails: this.trails.group, floor: this.floor,
      mesh: this.meshes.group, solids: this.solids.group};
    for (const [name, figures] of Object.entries(this.figures)) this.layers[name] = figures.group;
    for (const name of ['refined', 'raw', 'trails', 'mesh']) this.layers[name].visible = false;
  }

  addOverlay(i) {
    this.overlays[i] = new Figures(0.024, 0.009);
    this.layers[`overlay${i}`] = this.overlays[i].group;
    this.frontWorld.add(this.overlays[i].group);
  }

  background(colour) {
    this.scene.background = new THREE.Color(colour);
    this.draw();
  }

  resize() {
    const {clientWidth, clientHeight} = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.aim();
    this.draw();
  }

  // The plane a b c d of the floor, its normal up: the camera is d above it.
  stand(floor) {
    if (floor) {
      this.world.quaternion.setFromUnitVectors(new THREE.Vector3(floor[0], floor[1], floor[2]), UP);
      this.world.position.y = floor[3];
    } else if (this.world.position.y === 0) {
      this.world.position.y = EYE_HEIGHT_M;
    }
    this.world.updateMatrixWorld(true);
    this.frontWorld.position.copy(this.world.position);
    this.frontWorld.quaternion.copy(this.world.quaternion);
  }

  showMeshes() {
    if (!this.frame) return;
    this.meshes.show(this.frame.meshes);
    this.draw();
  }

  // frame: as connection.js reads it; overlays: bodies of each.
  show(frame, track, index, overlays) {
    this.frame = frame;
    this.stand(frame.layers.final.floor);
    this.cloud.show(frame);
    this.frustum.show(frame.camera);
    if (this.layers.mesh.visible) this.meshes.show(frame.meshes);
    this.solids.show(frame.solids);
    for (const [name, figures] of Object.entries(this.figures)) {
      figures.show(frame.layers[name].bodies, name === 'final' ? personColour : () => LAYERS[name]);
    }
    overlays.forEach((bodies, i) => this.overlays[i].show(bodies, () => OVERLAYS[i % OVERLAYS.length]));
    this.trails.show(track, index, personColour);
    this.follow();
    this.aim();
    this.draw();
  }

  followed() {
    const bodies = this.frame?.layers.final.bodies ?? [];
    const joints = (bodies.find(body => body.id === this.person) ?? bodies[0])?.joints;
    const joint = joints && (joints.Spine ?? joints.HipCenter ?? Object.values(joints)[0]);
    return joint && this.world.localToWorld(new THREE.Vector3(...joint.p));
  }

  follow() {
    const place = this.view === 'follow' && this.followed();
    if (!place) return;
    this.eye.position.add(place.clone().sub(this.controls.target));
    this.controls.target.copy(place);
    this.controls.update();
  }

  // orbit, camera, top, side or follow.
  setView(view) {
    this.view = view;
    const target = this.followed() ?? new THREE.Vector3(0, 0.9, 2.5);
    const from = {
      orbit: [1.3, 0.9, -2.9], top: [0, 5.5, -0.01], side: [4.5, 0.3, 0], follow: [0.9, 0.5, -2.4],
    }[view];
    this.controls.enabled = view !== 'camera';
    if (from) {
      this.controls.target.copy(target);
      this.eye.position.copy(target).add(new THREE.Vector3(...from));
      this.controls.update();
    }
    this.aim();
    this.draw();
  }

  // The eye's lens, and in the camera's view its place: then every pixel lies where the camera saw it.
  aim() {
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
    this.cloud.uniforms.canvasHeight.value = height * this.renderer.getPixelRatio();
    const camera = this.view === 'camera' && this.frame?.camera;
    this.eye.aspect = width / height;
    this.eye.fov = FIELD;
    this.eye.clearViewOffset();
    if (camera) this.aimAsCamera(camera, width, height);
    this.eye.updateProjectionMatrix();
  }

  aimAsCamera(camera, width, height) {
    const scale = Math.min(width / camera.width, height / camera.height);
    this.eye.fov = 2 * Math.atan(height / 2 / (camera.fy * scale)) * 180 / Math.PI;
    this.eye.aspect = width / height * camera.fy / camera.fx;
    const right = (camera.cx - camera.width / 2) * scale, down = (camera.cy - camera.height / 2) * scale;
    this.eye.setViewOffset(width, height, -right, -down, width, height);
    this.eye.aspect = width / height * camera.fy / camera.fx;  // setViewOffset sets it anew
    this.eye.position.copy(this.world.localToWorld(new THREE.Vector3()));
    this.eye.up.set(0, 1, 0).applyQuaternion(this.world.quaternion);
    this.eye.lookAt(this.world.localToWorld(new THREE.Vector3(0, 0, 1)));
    this.eye.up.copy(UP);
  }

  draw() {
    if (!this.renderer) return;
    this.renderer.clear();
    this.renderer.render(this.scene, this.eye);
    this.renderer.clearDepth();
    this.renderer.render(this.front, this.eye);
    this.drawLabels();
  }

  drawLabels() {
    this.labels.textContent = '';
    const bodies = this.layers.final.visible ? this.frame?.layers.final.bodies ?? [] : [];
    for (const {id, joints} of bodies) {
      if (joints.Head) this.label(`person ${id}`, this.world.localToWorld(new THREE.Vector3(...joints.Head.p)), '');
    }
    if (!this.floor.visible) return;
    for (let z = 1; z <= 6; ++z) this.label(`${z} m`, new THREE.Vector3(0, 0, z), 'metre');
  }

  label(text, place, kind) {
    const seen = place.clone().project(this.eye);
    if (Math.abs(seen.z) > 1) return;
    const span = document.createElement('span');
    span.textContent = text;
    span.className = kind;
    span.style.left = `${(seen.x + 1) / 2 * 100}%`;
    span.style.top = `${(1 - seen.y) / 2 * 100}%`;
    this.labels.append(span);
  }
}
