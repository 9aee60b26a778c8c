// The depth image and the parts image beside the 3D view, with the skeletons of the same frame.
import {FAR_MM, NEAR_MM, PALETTE, depthIndex, personColour} from './colours.js';
import {BONES, project} from './skeleton.js';

const depthColour = new Uint8Array(65536);
for (let mm = 0; mm < 65536; ++mm) depthColour[mm] = depthIndex(mm);
const words = new Uint32Array(PALETTE.buffer);  // RGBA, three rows of 256
const BLACK = 0xff000000;

function fill(canvas, width, height, colourAt) {
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext('2d');
  const image = context.createImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  for (let i = 0; i < pixels.length; ++i) pixels[i] = colourAt(i);
  context.putImageData(image, 0, 0);
  return context;
}

function drawSkeletons(context, frame, bodies) {
  const scale = 1 / frame.step;
  for (const {id, joints} of bodies) {
    context.strokeStyle = personColour(id);
    context.lineWidth = Math.max(2, frame.width / 160);
    for (const [parent, child] of BONES) {
      const from = joints[parent], to = joints[child];
      if (!from || !to) continue;
      context.globalAlpha = from.state === 'tracked' && to.state === 'tracked' ? 1 : 0.45;
      context.beginPath();
      context.moveTo(...project(frame.camera, from.p).map(x => x * scale));
      context.lineTo(...project(frame.camera, to.p).map(x => x * scale));
      context.stroke();
    }
  }
  context.globalAlpha = 1;
}

export function showPictures(depthCanvas, partsCanvas, frame) {
  const {width, height} = frame;
  if (!frame.depth) return;
  const mm = new Uint16Array(frame.depth.buffer, frame.depth.byteOffset, width * height);
  const depth = fill(depthCanvas, width, height, i => mm[i] ? words[depthColour[mm[i]]] : BLACK);
  drawSkeletons(depth, frame, frame.layers.final.bodies);
  if (!frame.parts) return;
  fill(partsCanvas, width, height, i => frame.parts[i] ? words[512 + frame.parts[i]] : frame.users[i] ? 0xff808080 : BLACK);
}

export const RANGE_TEXT = `${NEAR_MM / 1000} m (red) to ${FAR_MM / 1000} m (blue)`;
