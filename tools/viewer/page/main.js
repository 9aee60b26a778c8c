// The page: shows frames and skeletons from ossa in 3D, as pictures and over time.
import {drawStrip, overlayColour} from './charts.js';
import {LAYERS, personColour} from './colours.js';
import {Connection} from './connection.js';
import {connectKeys} from './keys.js';
import {Loader} from './loader.js';
import {$, CurvesPanel, LivePanel, SettingsPanel, WorstPanel} from './panels.js';
import {RANGE_TEXT, showPictures} from './pictures.js';
import {Player} from './player.js';
import {connectExport} from './saving.js';
import {Scene} from './scene.js';
import {Track} from './track.js';

const VIEWS = ['orbit', 'camera', 'top', 'side', 'follow'];

// Both throw in a browser that denies local storage.
function keptTheme() {
  try { return localStorage.getItem('theme'); } catch { return null; }
}
function keepTheme(name) {
  try { localStorage.setItem('theme', name); } catch { /* not kept */ }
}

class Page {
  constructor() {
    this.scene = new Scene($('scene'), $('labels'));
    this.track = new Track('final');
    this.overlays = [];
    this.loader = new Loader();
    this.player = new Player(new Connection(), frame => this.show(frame), state => this.updateState(state));
    const send = request => this.player.send(request);
    this.live = new LivePanel(send);
    this.settings = new SettingsPanel(send);
    this.curves = new CurvesPanel(() => {
      this.scene.person = Number($('person').value);
      this.drawCharts();
    });
    this.worst = new WorstPanel(frame => this.jump(frame));
    this.connectLayers();
    this.connectPlayer();
    this.connectKeys();
    this.connectTheme();
    connectExport(this.scene, this.player, () => this.span());
    this.setView('orbit');
    $('near_far').textContent = RANGE_TEXT;
    window.addEventListener('resize', () => this.drawCharts());
    this.player.onLost = () => {
      $('status').textContent = 'no connection';
      this.announce('no connection');
    };
    this.player.run();
  }

  get total() {
    return this.state?.kept ? Math.max(this.state.expected ?? 0, this.state.frames) : this.track.length;
  }
  get index() { return this.state?.kept ? this.frame?.number ?? 0 : this.track.length - 1; }

  span() { return [Number($('from').value), Number($('to').value)]; }

  show(frame) {
    this.frame = frame;
    if (!this.state.kept) this.track.addLive(frame.layers.final);
    this.live.show(frame);
    const time_s = frame.layers.final.time_s;
    const over = this.overlays.map(overlay => [...overlay.at(time_s)?.bodies ?? []].map(([id, joints]) => ({id, joints})));
    this.scene.show(frame, this.track, this.index, over);
    for (const [name, what] of [['mesh', frame.meshes], ['solids', frame.solids]]) this.revealLayer(name, what.length > 0);
    showPictures($('depth'), $('parts'), frame);
    $('pictures').hidden = !frame.depth;
    $('parts_figure').hidden = !frame.parts;
    this.showStatus();
    this.drawCharts();
    this.onShown?.(frame.number);
  }

  // Shows the switch of an optional layer once it has content.
  revealLayer(name, isThere) {
    if (isThere) document.querySelector(`[data-layer=${name}]`).parentElement.hidden = false;
  }

  showStatus() {
    const {final} = this.frame.layers;
    const count = final.bodies.length;
    const people = `${count} ${count === 1 ? 'person' : 'people'}`;
    $('status').textContent = `frame ${final.frame}, ${final.time_s.toFixed(2)} s, ${people}`;
    this.announce(people);
    const where = `frame ${this.index} of ${this.total} · ${final.time_s.toFixed(2)} s`;
    $('where').textContent = where;
    if (!this.player.playing) this.labelStrip(where);
    this.drawLegend();
  }

  // For screen readers: changes only, as they would read out every frame's number.
  announce(text) {
    if ($('spoken').textContent !== text) $('spoken').textContent = text;
  }

  labelStrip(where) {
    const values = {valuemin: 0, valuemax: Math.max(0, this.total - 1), valuenow: this.index, valuetext: where};
    for (const [name, value] of Object.entries(values)) $('strip').setAttribute(`aria-${name}`, value);
  }

  drawLegend() {
    const entries = this.frame.layers.final.bodies.map(({id}) => [`person ${id}`, personColour(id)]);
    for (const [name, colour] of Object.entries(LAYERS)) if (this.scene.layers[name].visible) entries.push([name, colour]);
    this.overlays.forEach((overlay, i) => entries.push([overlay.name, overlayColour(i)]));
    $('legend').replaceChildren(...entries.map(([text, colour]) => {
      const item = document.createElement('li'), dot = document.createElement('i');
      dot.style.background = colour;
      item.append(dot, text);
      return item;
    }));
  }

  drawCharts() {
    if (!this.state) return;
    if (this.state.kept) drawStrip($('strip'), this.track, this.total, this.index, this.span());
    if ($('curves_panel').open) this.curves.draw(this.track, this.overlays, this.total, this.index);
  }

  updateState(state) {
    // Another run of ossa at the same address: the content of an open page is outdated.
    if (this.state && state.begun_ms !== this.state.begun_ms) return location.reload();
    const isNew = state.generation !== this.state?.generation;
    this.state = state;
    if (isNew) this.begin();
    $('player').hidden = $('worst_panel').hidden = $('export_panel').hidden = !state.kept;
    this.live.update(state);
    this.settings.update(state);
    if (state.kept) this.loadTracks();
  }

  begin() {
    document.title = `${this.state.name} - ossa`;
    $('name').textContent = this.state.name;
    this.track = new Track('final');
    this.worst.key = null;
    if (!this.overlays.length) this.state.overlays.forEach((overlay, i) => this.addOverlay(overlay.name, i));
  }

  addOverlay(name, i) {
    this.overlays.push(new Track(name));
    this.scene.addOverlay(i);
    const label = document.createElement('label'), box = document.createElement('input');
    Object.assign(box, {type: 'checkbox', checked: true});
    box.dataset.layer = `overlay${i}`;
    box.onchange = () => this.switchLayer(box);
    label.append(box, ` ${name}`);
    $('overlays').append(label);
  }

  async loadTracks() {
    const track = this.track;
    let changed = await this.loader.load(track, 'final', this.state.frames);
    for (let i = 0; i < this.overlays.length; ++i) {
      changed = await this.loader.load(this.overlays[i], i, this.state.overlays[i].frames) || changed;
    }
    if (track !== this.track || !changed) return;
    this.player.times = track.times;
    if (Number($('to').value) === 0 || !this.spanIsChosen) $('to').value = track.length - 1;
    if (this.state.complete) this.player.stale = true;
    this.worst.show(track, this.overlays, this.state.complete);
    this.drawCharts();
  }

  jump(frame) {
    this.player.playing = false;
    this.player.seek(frame);
  }

  switchLayer(box) {
    this.scene.layers[box.dataset.layer].visible = box.checked;
    if (box.dataset.layer === 'mesh') this.scene.showMeshes();
    this.scene.draw();
    if (this.frame) this.drawLegend();
  }

  connectLayers() {
    for (const box of document.querySelectorAll('[data-layer]')) box.onchange = () => this.switchLayer(box);
    $('colour').onchange = () => {
      this.scene.cloud.mode = Number($('colour').value);
      this.scene.draw();
    };
    for (const button of document.querySelectorAll('[data-view]')) button.onclick = () => this.setView(button.dataset.view);
  }

  setView(view) {
    this.scene.person = Number($('person').value);
    this.scene.setView(view);
    for (const button of document.querySelectorAll('[data-view]')) {
      button.ariaPressed = button.dataset.view === view;
      button.classList.toggle('on', button.dataset.view === view);
    }
  }

  showPlaying() {
    $('play').textContent = this.player.playing ? '❚❚' : '▶';
    $('play').ariaLabel = this.player.playing ? 'pause' : 'play';
  }

  togglePlaying() {
    const atEnd = this.player.index >= this.player.times.length - 1;
    if (!this.player.playing && atEnd) this.player.seek(0);
    this.player.play(!this.player.playing);
  }

  connectPlayer() {
    $('play').onclick = () => this.togglePlaying();
    $('back').onclick = () => this.player.stepBy(-1);
    $('next').onclick = () => this.player.stepBy(1);
    $('speed').onchange = () => this.player.setSpeed(Number($('speed').value));
    $('loop').onchange = () => { this.player.loop = $('loop').checked; };
    $('measure').addEventListener('change', () => this.worst.show(this.track, this.overlays, this.state.complete));
    for (const id of ['from', 'to']) $(id).onchange = () => { this.spanIsChosen = true; this.drawCharts(); };
    for (const id of ['strip', 'curves']) this.connectScrubbing($(id));
    this.player.onPlaying = () => this.showPlaying();
    this.showPlaying();
  }

  connectScrubbing(canvas) {
    const scrub = event => {
      if (!event.buttons || !this.state?.kept) return;
      const box = canvas.getBoundingClientRect();
      this.jump(Math.floor((event.clientX - box.left) / box.width * this.total));
    };
    canvas.addEventListener('pointerdown', event => { canvas.setPointerCapture(event.pointerId); scrub(event); });
    canvas.addEventListener('pointermove', scrub);
  }

  toggle(selector) { document.querySelector(selector).click(); }

  connectKeys() {
    connectKeys([
      [[' '], 'play, pause', () => this.togglePlaying()],
      [[',', 'ArrowLeft'], 'one frame back', () => this.player.stepBy(-1)],
      [['.', 'ArrowRight'], 'one frame on', () => this.player.stepBy(1)],
      [['Home'], 'first frame', () => this.jump(0)],
      [['End'], 'last frame', () => this.jump(this.total - 1)],
      [['1', '2', '3', '4', '5'], 'orbit, camera, top, side, follow', key => this.setView(VIEWS[Number(key) - 1])],
      [['p'], 'points', () => this.toggle('[data-layer=cloud]')],
      [['c'], 'colour: depth, person, part', () => this.nextColour()],
      [['s', 'r', 'w'], 'skeleton: final, refined, raw', key => this.toggle(`[data-layer=${{s: 'final', r: 'refined', w: 'raw'}[key]}]`)],
      [['m', 'b'], 'fitted body, bodies of physics', key => this.toggle(`[data-layer=${{m: 'mesh', b: 'solids'}[key]}]`)],
      [['l'], 'trails', () => this.toggle('[data-layer=trails]')],
      [['f'], 'floor', () => this.toggle('[data-layer=floor]')],
      [['['], 'the span to export begins here', () => this.setSpan('from')],
      [[']'], 'the span to export ends here', () => this.setSpan('to')],
      [['t'], 'dark or light', () => this.toggle('#theme')],
    ]);
  }

  nextColour() {
    $('colour').value = (Number($('colour').value) + 1) % 3;
    $('colour').onchange();
  }

  setSpan(end) {
    $(end).value = this.index;
    $(end).onchange();
  }

  connectTheme() {
    const dark = window.matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark';
    this.theme(keptTheme() ?? dark);
    $('theme').onclick = () => this.theme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark');
  }

  theme(name) {
    document.documentElement.dataset.theme = name;
    keepTheme(name);
    this.scene.background(getComputedStyle(document.documentElement).getPropertyValue('--back').trim());
    this.drawCharts();
  }
}

try {
  window.page = new Page();  // for the tests, and for the console
} catch (error) {
  $('status').textContent = `this browser shows no 3D (WebGL): ${error.message}`;
  throw error;
}
