// Skeletons over time and quantities of them: curves, presence, error, worst frames.
import {JOINTS, angle, distance} from './skeleton.js';

const LIVE_FRAMES = 900;  // kept of a camera: half a minute at 30 frames a second

export class Track {
  constructor(name) {
    this.name = name;
    this.frames = [];  // {time_s, bodies: Map of id to joints by name, reliability: Map of id to its mean}
  }

  get length() { return this.frames.length; }
  get times() { return this.frames.map(frame => frame.time_s); }

  add(line) {
    const bodies = new Map(line.bodies.map(body => [body.id, body.joints]));
    const reliability = new Map(line.bodies.map(body => [body.id, meanOf(body.joints, 'reliability')]));
    this.frames.push({time_s: line.time_s, bodies, reliability});
  }

  addLive(line) {
    this.add(line);
    if (this.frames.length > LIVE_FRAMES) this.frames.shift();
  }

  people() {
    const ids = new Set();
    for (const frame of this.frames) for (const id of frame.bodies.keys()) ids.add(id);
    return [...ids].sort((a, b) => a - b);
  }

  joint(i, id, name) { return this.frames[i]?.bodies.get(id)?.[name]; }

  // The frame at a time, or none within half a frame of 30 a second.
  at(time_s) {
    let low = 0, high = this.frames.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.frames[middle].time_s < time_s) low = middle + 1; else high = middle;
    }
    const near = [low - 1, low].filter(i => this.frames[i]);
    const best = near.sort((a, b) => Math.abs(this.frames[a].time_s - time_s) - Math.abs(this.frames[b].time_s - time_s))[0];
    return best !== undefined && Math.abs(this.frames[best].time_s - time_s) <= 1 / 60 ? this.frames[best] : undefined;
  }
}

function mean(values) {
  const known = values.filter(Number.isFinite);
  return known.length ? known.reduce((a, b) => a + b, 0) / known.length : NaN;
}

// Metres from a body's joints to those of the nearest body of the other frame, by joint name.
export function errors(joints, other) {
  let best = {}, least = Infinity;
  for (const candidate of other?.bodies.values() ?? []) {
    const found = {};
    for (const name of JOINTS) {
      if (joints[name] && candidate[name]) found[name] = distance(joints[name].p, candidate[name].p);
    }
    const size = mean(Object.values(found));
    if (size < least) [best, least] = [found, size];
  }
  return best;
}

const bend = (a, b, c) => ({
  unit: '°', ofJoint: false,
  value: (track, i, id) => {
    const [from, at, to] = [a, b, c].map(name => track.joint(i, id, name));
    return from && at && to ? angle(from.p, at.p, to.p) : NaN;
  },
});
const coordinate = axis => ({unit: 'm', ofJoint: true, value: (track, i, id, joint) => track.joint(i, id, joint)?.p[axis] ?? NaN});
const member = name => ({unit: '', ofJoint: true, value: (track, i, id, joint) => track.joint(i, id, joint)?.[name] ?? NaN});

function speed(track, i, id, joint) {
  const before = track.joint(i - 1, id, joint), now = track.joint(i, id, joint);
  if (!before || !now) return NaN;
  const dt = track.frames[i].time_s - track.frames[i - 1].time_s;
  return dt > 0 ? distance(before.p, now.p) / dt : NaN;
}

// Centimetres to the overlay's same joint.
const toOverlay = {
  unit: 'cm', ofJoint: true, needsOverlay: true,
  value: (track, i, id, joint, overlay) => {
    const joints = track.frames[i]?.bodies.get(id);
    return joints && overlay ? 100 * (errors(joints, overlay.at(track.frames[i].time_s))[joint] ?? NaN) : NaN;
  },
};

export const QUANTITIES = {
  'position x (left)': coordinate(0),
  'position y (up)': coordinate(1),
  'position z (forward)': coordinate(2),
  'speed': {unit: 'm/s', ofJoint: true, value: speed},
  'left elbow': bend('ShoulderLeft', 'ElbowLeft', 'WristLeft'),
  'right elbow': bend('ShoulderRight', 'ElbowRight', 'WristRight'),
  'left knee': bend('HipLeft', 'KneeLeft', 'AnkleLeft'),
  'right knee': bend('HipRight', 'KneeRight', 'AnkleRight'),
  'confidence': member('confidence'),
  'reliability': member('reliability'),
  'error': toOverlay,
};

export const meanOf = (joints, name) => mean(Object.values(joints).map(joint => joint[name]));

function overBodies(track, i, choose, value) {
  const values = [...track.frames[i].bodies.entries()].map(([id, joints]) => value(id, joints)).filter(Number.isFinite);
  return values.length ? choose(...values) : NaN;
}

// Value of a frame; larger is worse.
export const MEASURES = {
  'error to the overlay': {
    unit: 'cm', digits: 1, needsOverlay: true,
    value: (track, i, overlay) => 100 * overBodies(track, i, Math.max,
      (id, joints) => mean(Object.values(errors(joints, overlay?.at(track.frames[i].time_s))))),
  },
  'least reliable': {
    unit: 'mean reliability', digits: 2, sign: -1,
    value: (track, i) => overBodies(track, i, Math.min, (id, joints) => meanOf(joints, 'reliability')),
  },
  'least confident': {
    unit: 'mean confidence', digits: 2, sign: -1,
    value: (track, i) => overBodies(track, i, Math.min, (id, joints) => meanOf(joints, 'confidence')),
  },
  'fastest joint': {
    unit: 'm/s', digits: 1,
    value: (track, i) => overBodies(track, i, Math.max,
      id => Math.max(...JOINTS.map(joint => speed(track, i, id, joint)).filter(Number.isFinite))),
  },
};

// The ten worst frames, none within five frames of a worse one: {frame, value}.
export function worstFrames(track, measure, overlay) {
  const sign = measure.sign ?? 1;
  const all = track.frames.map((_, frame) => ({frame, value: measure.value(track, frame, overlay)}))
    .filter(one => Number.isFinite(one.value)).sort((a, b) => sign * (b.value - a.value));
  const worst = [];
  for (const one of all) {
    if (worst.length === 10) break;
    if (worst.every(other => Math.abs(other.frame - one.frame) > 5)) worst.push(one);
  }
  return worst;
}
