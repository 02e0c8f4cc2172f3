// The one worker: it loads the module and answers one request after the other. While a run is
// computed it hears `stop`, `pause`, `resume` and `line` where the engine can suspend WebAssembly.

import { load, suspends } from "../../../bindings/web/gapilib.js";

let gapilib = null;
let commands = { stop: false, lines: [], resumed: null };

/** Lets the messages in that have come. */
function messages() {
  return new Promise((done) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      done();
    };
    port2.postMessage(0);
  });
}

const host = {
  send: (event) => postMessage({ event }),
  poll: suspends ? async () => {
    await messages();
    if (commands.paused && !commands.stop) {
      postMessage({ event: { paused: true } });
      await new Promise((resumed) => { commands.resumed = resumed; });
    }
    return command();
  } : command,
  nextLine: () => commands.lines.shift() ?? null,
};

function command() {
  return commands.stop ? 1 : commands.lines.length > 0 ? 2 : 0;
}

const CONTROLS = {
  stop() { commands.stop = true; commands.resumed?.(); },
  pause() { commands.paused = true; },
  resume() { commands.paused = false; commands.resumed?.(); },
  line(text) { commands.lines.push(text); },
};

const REQUESTS = {
  async load(source) {
    const packed = source instanceof ArrayBuffer ? new Blob([source]) : await (await fetch(source)).blob();
    const unpacked = packed.stream().pipeThrough(new DecompressionStream("gzip"));
    gapilib = await load(await new Response(unpacked).arrayBuffer());
    return { suspends };
  },
  run({ script, files, options }) {
    commands = { stop: false, lines: [], paused: false, resumed: null };
    return gapilib.start(script, files, options, host);
  },
  // A run that nobody watches, without a clock: what the tests compare.
  plain: ({ script, files, write }) => gapilib.run(script, files, { write }),
  steps: () => gapilib.steps(),
  lessons: () => gapilib.ask({ lessons: {} }),
  check: (check) => gapilib.ask({ check }),
};

onmessage = async ({ data: { id, what, value } }) => {
  if (CONTROLS[what]) return CONTROLS[what](value);
  try {
    postMessage({ id, answer: await REQUESTS[what](value) });
  } catch (error) {
    postMessage({ id, failed: error.message });
  }
};
