// Skeletons of the whole recording, as far as it is tracked, loaded piece by piece.

async function loadInto(track, layer) {
  const answer = await fetch(`/lines?layer=${layer}&from=${track.length}`);
  const lines = (await answer.text()).split('\n').filter(Boolean);
  for (const line of lines) track.add(JSON.parse(line));
  return lines.length;
}

export class Loader {
  constructor() {
    this.busy = false;
  }

  // Loads until the track has `frames`; false where it has them already. One load at a time.
  async load(track, layer, frames) {
    if (this.busy || track.length >= frames) return false;
    this.busy = true;
    try {
      while (track.length < frames && await loadInto(track, layer) > 0);
    } finally {
      this.busy = false;
    }
    return true;
  }
}
