// The depth image as points in space. Positions and colours of the points are computed on the graphics card, from the
// images as they were received.
import * as THREE from '/three/build/three.module.js';
import {FAR_MM, NEAR_MM, PALETTE} from './colours.js';

const VERTEX = `
attribute vec2 pixel;
uniform sampler2D depth, users, parts, palette;
uniform vec2 size;
uniform vec4 intrinsics;
uniform float between, mode, canvasHeight;
varying vec3 colour;
void main() {
  vec2 at = (pixel + 0.5) / size;
  vec4 bytes = texture2D(depth, at);
  float mm = floor(bytes.r * 255.0 + 0.5) + 256.0 * floor(bytes.a * 255.0 + 0.5);
  float z = mm / 1000.0;
  vec3 place = vec3((intrinsics.zw - pixel * between) * z / intrinsics.xy, z);
  gl_Position = mm > 0.0 ? projectionMatrix * modelViewMatrix * vec4(place, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = clamp(1.3 * between * z / intrinsics.y * projectionMatrix[1][1] * canvasHeight / 2.0 / gl_Position.w, 1.0, 32.0);
  float near = clamp((mm - ${NEAR_MM}.0) / ${FAR_MM - NEAR_MM}.0, 0.0, 1.0);
  float label = 255.0 * (mode < 0.5 ? near : mode < 1.5 ? texture2D(users, at).r : texture2D(parts, at).r);
  colour = texture2D(palette, vec2((floor(label + 0.5) + 0.5) / 256.0, (mode + 0.5) / 3.0)).rgb;
  if (mode > 0.5 && label < 0.5) colour *= 1.1 - 0.6 * near;
}`;
const FRAGMENT = `
varying vec3 colour;
void main() { gl_FragColor = vec4(colour, 1.0); }`;

function texture(data, width, height, format) {
  const made = new THREE.DataTexture(data, width, height, format, THREE.UnsignedByteType);
  made.needsUpdate = true;
  return made;
}

function pixelsOf(width, height) {
  const pixels = new Float32Array(width * height * 2);
  for (let i = 0; i < width * height; ++i) pixels.set([i % width, Math.floor(i / width)], 2 * i);
  return pixels;
}

export class Cloud {
  constructor() {
    const none = texture(new Uint8Array(4), 1, 1, THREE.LuminanceFormat);
    this.uniforms = {
      depth: {value: none}, users: {value: none}, parts: {value: none},
      palette: {value: texture(PALETTE, 256, 3, THREE.RGBAFormat)},
      size: {value: new THREE.Vector2()}, intrinsics: {value: new THREE.Vector4()},
      between: {value: 1}, mode: {value: 1}, canvasHeight: {value: 1},
    };
    const material = new THREE.ShaderMaterial({uniforms: this.uniforms, vertexShader: VERTEX, fragmentShader: FRAGMENT});
    this.points = new THREE.Points(new THREE.BufferGeometry(), material);
    this.points.frustumCulled = false;
    this.resize(1, 1);
  }

  set mode(mode) { this.uniforms.mode.value = mode; }

  resize(width, height) {
    this.points.geometry.dispose();
    this.points.geometry = new THREE.BufferGeometry();
    // three.js counts the points by `position`; their positions come from the depth image.
    this.points.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(width * height * 3), 3));
    this.points.geometry.setAttribute('pixel', new THREE.BufferAttribute(pixelsOf(width, height), 2));
    this.uniforms.size.value.set(width, height);
  }

  put(name, data, width, height, format) {
    const uniform = this.uniforms[name];
    if (uniform.value.image.width === width && uniform.value.image.height === height) {
      uniform.value.image.data = data;
      uniform.value.needsUpdate = true;
      return;
    }
    uniform.value.dispose();
    uniform.value = texture(data, width, height, format);
  }

  show(frame) {
    this.shown = Boolean(frame.depth);
    if (!frame.depth) return;
    const {width, height, camera, step} = frame;
    if (this.uniforms.size.value.x !== width || this.uniforms.size.value.y !== height) this.resize(width, height);
    this.put('depth', frame.depth, width, height, THREE.LuminanceAlphaFormat);
    if (frame.users) this.put('users', frame.users, width, height, THREE.LuminanceFormat);
    if (frame.parts) this.put('parts', frame.parts, width, height, THREE.LuminanceFormat);
    this.uniforms.intrinsics.value.set(camera.fx, camera.fy, camera.cx, camera.cy);
    this.uniforms.between.value = step;
  }
}
