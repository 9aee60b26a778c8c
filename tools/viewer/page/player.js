// What frame is asked for next: of a camera the newest, of a recording that of the clock or of the hand.
const IDLE_MS = 400;  // between looks at a state that does not change

const wait = ms => new Promise(resolve => setTimeout(resolve, ms));

export class Player {
  // show(moment), learn(state): told of what comes.
  constructor(connection, show, learn) {
    Object.assign(this, {connection, show, learn});
    this.index = 0;
    this.shown = -1;
    this.playing = true;
    this.speed = 1;
    this.loop = true;
    this.step = window.innerWidth < 800 ? 2 : 1;  // a phone need not load every pixel
    this.times = [];
    this.wishes = [];
    this.frames = 0;
    this.start();
  }

  // It may end by itself: at the last frame, or where one frame is wanted.
  get playing() { return this.isPlaying; }
  set playing(playing) {
    this.isPlaying = playing;
    this.onPlaying?.();
  }

  // The clock begins at the frame that is shown.
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

  next() {
    if (!this.kept) return {after: this.shown, step: this.step};
    this.advance();
    return this.index === this.shown && !this.stale ? {state: true} : {frame: this.index, step: this.step};
  }

  take(answer) {
    if (answer.state) this.takeState(answer.state);
    if (!answer.moment) return;
    this.shown = answer.moment.number;
    this.stale = false;
    this.show(answer.moment);
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
    this.learn(state);
  }

  async run() {
    this.take(await this.connection.ask({state: true}));
    for (;;) {
      const wish = this.wishes.shift() ?? this.next();
      const answer = await this.connection.ask(wish);
      this.take(answer);
      if (answer.lost) { this.generation = null; this.onLost?.(); await wait(IDLE_MS); }
      if (this.kept) await this.pause(wish);
    }
  }

  // A moment without a new question: until the next frame is due, or something is asked.
  pause(wish) {
    if (wish.state && !this.playing) return Promise.race([wait(IDLE_MS), new Promise(resolve => { this.onChange = resolve; })]);
    return new Promise(resolve => { if (document.hidden) setTimeout(resolve, 30); else requestAnimationFrame(resolve); });
  }

  // Shows a frame; done once it is on the screen.
  showFrame(index) {
    this.playing = false;
    this.stale = true;
    this.seek(index);
    return new Promise(resolve => { this.onceShown = [index, resolve]; });
  }

  // Settings or the record button, with the next question, which may be a second away: more than one may wait.
  tell(wish) {
    this.wishes.push(wish);
    this.onChange?.();
  }
}
