// The wire: binary messages of a run become plain objects with typed arrays (layout: slam/serve/messages.py).

const TYPES = { f4: Float32Array, i4: Int32Array, u1: Uint8Array };

export function unpack(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const { arrays, ...message } = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  for (const [name, { type, shape, at }] of Object.entries(arrays)) {
    const count = shape.reduce((product, extent) => product * extent, 1);
    message[name] = new TYPES[type](buffer, 4 + length + at, count);
  }
  return message;
}

// Follow a run from its first message; `take` gets each, `lost` hears when the server is gone. Returns how to stop.
export function follow(number, take, lost) {
  const socket = new WebSocket(`${location.origin.replace(/^http/, "ws")}/runs/${number}/live`);
  let ended = false;
  socket.binaryType = "arraybuffer";
  socket.onmessage = (event) => {
    const message = unpack(event.data);
    ended = message.kind === "done" || message.kind === "failed";
    take(message);
  };
  socket.onclose = () => { if (!ended) lost(); };
  return () => { ended = true; socket.onmessage = null; socket.close(); };
}

export async function asked(path, options = {}) {
  const answer = await fetch(path, options);
  if (!answer.ok) throw new Error(await reasonIn(answer));
  return answer;
}

async function reasonIn(answer) {
  const text = await answer.text();
  try { return JSON.parse(text).reason; } catch { return text || `the server answered ${answer.status}`; }
}
