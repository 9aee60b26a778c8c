// The strip of people over time, and the curves: plain 2D canvases.
import {OVERLAYS, personColour} from './colours.js';

export function prepare(canvas) {
  const ratio = window.devicePixelRatio, {clientWidth, clientHeight} = canvas;
  canvas.width = Math.round(clientWidth * ratio);
  canvas.height = Math.round(clientHeight * ratio);
  const context = canvas.getContext('2d');
  context.scale(ratio, ratio);
  context.font = '11px system-ui, "DejaVu Sans", sans-serif';
  const style = getComputedStyle(document.documentElement);
  const colour = name => style.getPropertyValue(`--${name}`).trim();
  return {context, width: clientWidth, height: clientHeight, colour};
}

// A row a person, bright where the joints are reliable on average; the cursor; the span to export.
export function drawStrip(canvas, track, total, index, span) {
  const {context, width, height, colour} = prepare(canvas);
  context.fillStyle = colour('panel');
  context.fillRect(0, 0, width, height);
  const x = i => i / Math.max(1, total) * width;
  context.fillStyle = colour('line');
  context.fillRect(x(span[0]), height - 4, x(span[1] + 1) - x(span[0]), 4);
  const people = track.people();
  const row = (height - 6) / Math.max(1, people.length);
  const stride = Math.max(1, Math.floor(total / width));  // a long recording has more frames than the strip pixels
  for (let i = 0; i < track.length; i += stride) {
    for (const [id, reliability] of track.frames[i].reliability) {
      context.fillStyle = personColour(id);
      context.globalAlpha = 0.15 + 0.85 * (reliability || 0.5);
      context.fillRect(x(i), people.indexOf(id) * row + 1, Math.max(1, x(i + stride) - x(i) + 0.3), row - 2);
    }
  }
  context.globalAlpha = 1;
  context.fillStyle = colour('text');
  const every = Math.ceil(11 / row);  // of many people some are named: names are 11 pixels high
  people.forEach((id, k) => { if (k % every === 0) context.fillText(`person ${id}`, 4, (k + 0.5) * row + 4); });
  context.fillRect(x(index + 0.5) - 1, 0, 2, height);
}

// A loop: Math.min(...values) fails for the number of values of an hour.
function range(lines) {
  let low = Infinity, high = -Infinity;
  for (const value of lines.flat()) {
    if (!Number.isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return null;
  const margin = (high - low || Math.abs(high) || 1) * 0.06;
  return [low - margin, high + margin];
}

function polyline(context, values, x, y) {
  context.beginPath();
  let down = false;
  values.forEach((value, i) => {
    if (!Number.isFinite(value)) { down = false; return; }
    if (down) context.lineTo(x(i), y(value)); else context.moveTo(x(i), y(value));
    down = true;
  });
  context.stroke();
}

// lines: one of the track and one for each overlay, a value a frame, NaN where there is none.
export function drawCurves(canvas, lines, colours, total, index, unit) {
  const {context, width, height, colour} = prepare(canvas);
  context.fillStyle = colour('panel');
  context.fillRect(0, 0, width, height);
  const bounds = range(lines);
  context.fillStyle = colour('dim');
  if (!bounds) { context.fillText('no values', 8, 18); return; }
  const x = i => (i + 0.5) / Math.max(1, total) * width;
  const y = value => height - (value - bounds[0]) / (bounds[1] - bounds[0]) * height;
  context.strokeStyle = colour('line');
  for (const share of [0.15, 0.5, 0.85]) {
    const value = bounds[0] + share * (bounds[1] - bounds[0]);
    context.beginPath(); context.moveTo(0, y(value)); context.lineTo(width, y(value)); context.stroke();
    context.fillText(`${value.toFixed(2)} ${unit}`, 4, y(value) - 3);
  }
  lines.forEach((values, k) => {
    context.strokeStyle = colours[k];
    context.lineWidth = 1.5;
    polyline(context, values, x, y);
  });
  context.fillStyle = colour('text');
  context.fillRect(x(index) - 0.5, 0, 1, height);
}

export const overlayColour = i => OVERLAYS[i % OVERLAYS.length];
