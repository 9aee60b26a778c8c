// Which frame is requested next: of a camera the newest, of a recording that of the clock or of the user.
const IDLE_MS = 400;  // between requests for a state that does not change

const wait = ms => new Promise(resolve => setTimeout(resolve, ms));

export class Player {
  // show(frame), updateState(state): called for each answer.
  constructor(connection, show, updateState) {
    Object.assign(this, {connection, show, updateState});
    this.index = 0;
    this.shown = -1;
    this.playing = true;
    this.speed = 1;
    this.loop = true;
    this.step = window.innerWidth < 800 ? 2 : 1;  // a phone need not load every pixel
    this.times = [];
    this.requests = [];
    this.frames = 0;
    this.start();
  }

  // Playing also ends at the last frame, and when a single frame is shown.
  get playing() { return this.isPlaying; }
  set playing(playing) {
    this.isPlaying = playing;
    this.onPlaying?.();
  }

  // Starts the clock at the current frame.
  start() {
    this.started = {wall: performance.now(), time_s: this.times[this.index] ?? 0};
  }

  play(playing) {
    this.playing = playing;
    this.start();
    this.onChange?.();
  }

  setSpeed(speed) {
    this.speed = speed;
    this.start();
  }

  seek(index) {
    this.index = Math.max(0, Math.min(this.frames - 1, index));
    this.start();
    this.onChange?.();
  }

  stepBy(frames) {
    this.playing = false;
    this.seek(this.index + frames);
  }

  advance() {
    if (!this.playing || !this.times.length) return;
    const time_s = this.started.time_s + (performance.now() - this.started.wall) / 1000 * this.speed;
    const last = this.times.length - 1;
    while (this.index < last && this.times[this.index + 1] <= time_s) this.index += 1;
    if (this.index < last || time_s < this.times[last] + 1 / 30) return;
    if (!this.complete) return this.start();  // the tracker is slower than the recording
    if (this.loop) this.seek(0); else this.play(false);
  }

  nextRequest() {
    if (!this.kept) return {after: this.shown, step: this.step};
    this.advance();
    return this.index === this.shown && !this.stale ? {state: true} : {frame: this.index, step: this.step};
  }

  take(answer) {
    if (answer.state) this.takeState(answer.state);
    if (!answer.frame) return;
    this.shown = answer.frame.number;
    this.stale = false;
    this.show(answer.frame);
    if (this.onceShown?.[0] === this.shown) this.onceShown[1]();
  }

  takeState(state) {
    this.kept = state.kept;
    this.frames = state.frames;
    this.complete = state.complete;
    if (state.generation !== this.generation) {
      this.generation = state.generation;
      this.stale = true;
      this.seek(0);
    }
    this.updateState(state);
  }

  async run() {
    this.take(await this.connection.request({state: true}));
    for (;;) {
      const request = this.requests.shift() ?? this.nextRequest();
      const answer = await this.connection.request(request);
      this.take(answer);
      if (answer.lost) { this.stale = true; this.onLost?.(); await wait(IDLE_MS); }
      if (this.kept) await this.pause(request);
    }
  }

  // Waits until the next frame is due, or until the user does something.
  pause(request) {
    if (request.state && !this.playing) return Promise.race([wait(IDLE_MS), new Promise(resolve => { this.onChange = resolve; })]);
    return new Promise(resolve => { if (document.hidden) setTimeout(resolve, 30); else requestAnimationFrame(resolve); });
  }

  // Shows a frame; resolves once it is drawn.
  showFrame(index) {
    this.playing = false;
    this.stale = true;
    this.seek(index);
    return new Promise(resolve => { this.onceShown = [index, resolve]; });
  }

  // Queues settings or the record button; the current request may take up to a second.
  send(request) {
    this.requests.push(request);
    this.onChange?.();
  }
}
