// The WebSocket: one request, one answer, in turn. A slow browser requests less often and so gets fewer frames.

// A binary message: length of the header, header (JSON), depth (16 bit), persons and parts (8 bit each),
// corners of fitted bodies (16 bit, half millimetres).
function readMeshes(buffer, begin, meshes) {
  return meshes.map(({id, vertices}) => {
    const corners = Float32Array.from(new Int16Array(buffer, begin, 3 * vertices), x => x / 2000);
    begin += 6 * vertices;
    return {id, corners};
  });
}

function readFrame(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const pixels = header.width * header.height;
  const begin = 4 + length;
  header.depth = header.planes > 0 ? new Uint8Array(buffer, begin, pixels * 2) : null;
  header.users = header.planes > 1 ? new Uint8Array(buffer, begin + pixels * 2, pixels) : null;
  header.parts = header.planes > 1 ? new Uint8Array(buffer, begin + pixels * 3, pixels) : null;
  const bytes = header.planes > 1 ? 4 : header.planes > 0 ? 2 : 0;
  header.meshes = readMeshes(buffer, begin + pixels * bytes, header.meshes);
  return header;
}

function readAnswer(data) {
  if (data instanceof ArrayBuffer) {
    const frame = readFrame(data);
    return {frame, state: frame.state};
  }
  const json = JSON.parse(data);
  return json.error ? {error: json.error} : {state: json};
}

export class Connection {
  constructor() {
    this.waiting = [];
    this.open();
  }

  open() {
    this.socket = new WebSocket(`ws://${location.host}/socket`);
    this.socket.binaryType = 'arraybuffer';
    // Also resolved when it never opens: requests that wait for it must end.
    this.opened = new Promise(resolve => { this.socket.onopen = this.resolveOpened = resolve; });
    this.socket.onmessage = event => this.waiting.shift()?.(readAnswer(event.data));
    this.socket.onclose = () => this.handleClose();
  }

  handleClose() {
    this.resolveOpened();
    this.waiting.splice(0).forEach(answer => answer({lost: true}));
    setTimeout(() => this.open(), 1000);
  }

  // {frame, state}, {state}, {error} or {lost: true}.
  async request(message) {
    await this.opened;
    if (this.socket.readyState !== WebSocket.OPEN) return this.answerLost();
    return new Promise(resolve => {
      this.waiting.push(resolve);
      this.socket.send(JSON.stringify(message));
    });
  }

  answerLost() {
    return new Promise(resolve => setTimeout(() => resolve({lost: true}), 500));
  }
}
