// The panels beside the view: live figures, settings, curves, worst frames, export.
import {drawCurves, overlayColour} from './charts.js';
import {personColour} from './colours.js';
import {JOINTS} from './skeleton.js';
import {MEASURES, QUANTITIES, worstFrames} from './track.js';

export const $ = id => document.getElementById(id);

// What the user chose stays chosen as long as it is among the names.
export function fillSelect(select, names, chosen) {
  const wanted = names.join('\n');
  if (select.dataset.names === wanted) return;
  select.dataset.names = wanted;
  const kept = names.includes(select.value) ? select.value : chosen;
  select.replaceChildren(...names.map(name => new Option(name || 'of the method', name)));
  if (kept !== undefined) select.value = kept;
}

const STAGES = ['segment', 'classify', 'propose', 'reconstruct', 'physics', 'total'];

function stageRow(name, ms, whole) {
  const row = document.createElement('tr');
  const bar = document.createElement('span');
  bar.className = 'bar';
  bar.style.width = `${Math.round(80 * Math.min(1, ms / (whole || 1)))}px`;
  const cells = [name, bar, `${ms.toFixed(1)} ms`].map(content => {
    const cell = document.createElement('td');
    cell.append(content);
    return cell;
  });
  row.append(...cells);
  return row;
}

export class LivePanel {
  constructor(send) {
    this.arrivals = [];
    $('record').onclick = () => send({record: !this.recording});
  }

  show(frame) {
    $('live').hidden = frame.ms.total === 0;
    $('stages').replaceChildren(...STAGES.map(name => stageRow(name, frame.ms[name], frame.ms.total)));
    const now = performance.now();
    this.arrivals = [...this.arrivals.filter(at => now - at < 2000), now];
    const fps = (this.arrivals.length - 1) / ((now - this.arrivals[0]) / 1000 || 1);
    $('flow').textContent =
      `${fps.toFixed(0)} frames/s here, ${frame.dropped} dropped, latency ${frame.latency_ms.toFixed(0)} ms`;
  }

  update({recording}) {
    this.recording = recording.on;
    $('record').hidden = !recording.possible;
    $('record').classList.toggle('on', recording.on);
    $('record').textContent = recording.on ? '■ stop' : '● record';
    $('recorded').textContent = recording.status;
  }
}

export class SettingsPanel {
  constructor(send) {
    this.inputs = [...document.querySelectorAll('[data-setting]')];
    for (const input of this.inputs) {
      input.onchange = () => send({settings: {[input.dataset.setting]: this.valueOf(input)}});
    }
  }

  valueOf(input) {
    if (input.type === 'checkbox') return input.checked;
    return input.type === 'number' ? Number(input.value) : input.value;
  }

  update({settings, methods, smoothings, refused}) {
    $('settings').hidden = !settings;
    $('refused').textContent = refused;
    if (!settings) return;
    fillSelect(document.querySelector('[data-setting=method]'), methods);
    fillSelect(document.querySelector('[data-setting=smoothing]'), ['', ...smoothings]);
    for (const input of this.inputs) {
      if (input === document.activeElement) continue;
      if (input.type === 'checkbox') input.checked = settings[input.dataset.setting];
      else input.value = settings[input.dataset.setting];
    }
  }
}

export class CurvesPanel {
  constructor(redraw) {
    fillSelect($('quantity'), Object.keys(QUANTITIES), 'position y (up)');
    fillSelect($('joint'), JOINTS, 'HandRight');
    for (const id of ['quantity', 'joint', 'person']) $(id).onchange = redraw;
  }

  draw(track, overlays, total, index) {
    fillSelect($('person'), track.people().map(String));
    const id = Number($('person').value), joint = $('joint').value, quantity = QUANTITIES[$('quantity').value];
    $('joint').disabled = !quantity.ofJoint;
    const lines = this.lines(track, overlays, quantity, id, joint);
    drawCurves($('curves'), lines, [personColour(id), ...overlays.map((_, i) => overlayColour(i))], total, index, quantity.unit);
    const value = lines[0][index];
    $('value').textContent = Number.isFinite(value) ? `${value.toFixed(3)} ${quantity.unit} at frame ${index}` : ' ';
  }

  // Cached until the selection or the number of frames changes: it visits every frame.
  lines(track, overlays, quantity, id, joint) {
    const key = JSON.stringify([$('quantity').value, id, joint, track.frames.at(-1)?.time_s, track.length, overlays.map(overlay => overlay.length)]);
    if (key !== this.key || track !== this.track) {
      const line = track.frames.map((_, i) => quantity.value(track, i, id, joint, overlays[0]));
      const others = quantity.needsOverlay ? [] : overlays.map(overlay => this.overlayLine(track, overlay, quantity, joint));
      Object.assign(this, {key, track, kept: [line, ...others]});
    }
    return this.kept;
  }

  // The curve of the overlay's first person at the times of the track.
  overlayLine(track, overlay, quantity, joint) {
    const id = overlay.people()[0];
    return track.frames.map(frame => {
      const i = overlay.frames.indexOf(overlay.at(frame.time_s));
      return i < 0 ? NaN : quantity.value(overlay, i, id, joint);
    });
  }
}

export class WorstPanel {
  constructor(seek) {
    this.seek = seek;
    $('measure').onchange = () => { this.key = null; };
  }

  // Cached until enough frames are added: it visits every frame.
  show(track, overlays, complete) {
    const names = Object.keys(MEASURES).filter(name => overlays.length || !MEASURES[name].needsOverlay);
    fillSelect($('measure'), names, names[0]);
    const key = `${$('measure').value} ${complete ? track.length : Math.floor(track.length / 60)} ${overlays[0]?.length}`;
    if (key === this.key) return;
    this.key = key;
    const measure = MEASURES[$('measure').value];
    $('worst').replaceChildren(...worstFrames(track, measure, overlays[0]).map(one => this.row(one, measure)));
  }

  row({frame, value}, measure) {
    const button = document.createElement('button');
    button.textContent = `frame ${frame}: ${value.toFixed(measure.digits)} ${measure.unit}`;
    button.onclick = () => this.seek(frame);
    const item = document.createElement('li');
    item.append(button);
    return item;
  }
}
