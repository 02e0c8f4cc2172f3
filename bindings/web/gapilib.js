// Runs GAPILib scripts with their files in memory, in a browser or in node.
//
//   const gapilib = await load(bytes);            // of gapilib.wasm, or a WebAssembly.Module
//   const run = gapilib.run("decay.mos", { "decay.mos": "print(\"hello\")" });
//   run.exit_code, run.output, run.errors, run.transcript, run.files["results/result.json"]
//
// A run is computed where it is called: in a page, call it from a worker. `start` is the same for a
// run that somebody watches: it sends events, and where the engine can suspend WebAssembly
// (JavaScript Promise Integration) it lets messages in, so that a run can be stopped and changed.

/** The module is at fault, not the script. What was loaded starts again with the next run. */
export class GapilibError extends Error {
  name = "GapilibError";
}

/** Whether a run can be stopped and changed while it is computed. */
export const suspends = typeof WebAssembly.Suspending === "function" && typeof WebAssembly.promising === "function";

/** What a run asks of its host if nobody watches. */
const NOBODY = { send() {}, poll: () => 0, nextLine: () => null };

/** Compiles the module. `source` is its bytes or a `WebAssembly.Module`. */
export async function load(source) {
  const module = source instanceof WebAssembly.Module ? source : await WebAssembly.compile(source);
  return new Gapilib(module);
}

/** An instance of the module, and who answers its questions. */
class Instance {
  host = NOBODY;

  constructor(module, canSuspend) {
    const poll = () => this.host.poll();
    const imports = {
      monotonic: () => performance.now() / 1000,
      unix: () => Date.now() / 1000,
      poll: canSuspend ? new WebAssembly.Suspending(poll) : poll,
      next_line: () => this.#nextLine(),
      send: (place, length) => this.host.send(JSON.parse(this.#text(place, length))),
    };
    this.exports = new WebAssembly.Instance(module, { host: imports }).exports;
    this.run = canSuspend ? WebAssembly.promising(this.exports.run) : this.exports.run;
  }

  #text(place, length) {
    return new TextDecoder().decode(new Uint8Array(this.exports.memory.buffer, place >>> 0, length >>> 0));
  }

  #nextLine() {
    const line = this.host.nextLine();
    if (line === null) return 0;
    this.write(line);
    return 1;
  }

  write(text) {
    const bytes = new TextEncoder().encode(text);
    const place = this.exports.request(bytes.length) >>> 0;
    new Uint8Array(this.exports.memory.buffer, place, bytes.length).set(bytes);
  }

  /** The answer, or the message of a panic. */
  answer() {
    return this.#text(this.exports.answer(), this.exports.answer_length());
  }
}

class Gapilib {
  #module;
  #instances = {};

  constructor(module) {
    this.#module = module;
  }

  /**
   * Runs a script.
   *
   * `files` are strings or `Uint8Array`s by their paths from the working directory; `script` is the
   * path of one of them. With `write`, the script may change files that it has not made. The answer
   * has `exit_code`, `output`, `errors` (diagnostics as the terminal shows them), `transcript`, and
   * `files`: what is new or changed, as `Uint8Array`s.
   *
   * Throws `GapilibError` if the request cannot be read, the module panics, or the stack of the
   * JavaScript engine ends.
   */
  run(script, files, { write = false } = {}) {
    return decoded(this.ask({ run: { script, files: encoded(files), write } }));
  }

  /**
   * The same for a run that somebody watches: `host.send` gets the events, `host.poll` returns 1
   * to stop and 2 where `host.nextLine` has statements to be executed before the next generation (a
   * promise of it where `suspends`). `changes` are statements with the generations that they are
   * executed in, and end the run where one is impossible; `typed` are those that the user has typed,
   * of which an impossible one is refused. With `compare` the run is shown beside the one before;
   * with `last` it ends with this generation.
   */
  async start(script, files, options, host) {
    const { changes = [], typed = [], compare = false, last = null } = options;
    const request = { script, files: encoded(files), live: true, changes, typed, compare, last };
    return decoded(await this.#asked({ run: request }, suspends, host));
  }

  /** The page of the steps of the run that was started last, and of what it was compared with. */
  async steps() {
    return (await this.#asked({ steps: {} }, suspends, NOBODY)).html;
  }

  /** Answers another request: `{ lessons: {} }` or `{ check: { lesson, text, companions } }`. */
  ask(request) {
    const instance = this.#take(false, NOBODY);
    try {
      instance.write(JSON.stringify(request));
      instance.run();
    } catch (trap) {
      throw failed(instance, trap);
    }
    return this.#answered(instance, false);
  }

  async #asked(request, canSuspend, host) {
    const instance = this.#take(canSuspend, host);
    try {
      instance.write(JSON.stringify(request));
      await instance.run();
    } catch (trap) {
      throw failed(instance, trap);
    }
    return this.#answered(instance, canSuspend);
  }

  // What a trap leaves behind is not to be trusted: the next run gets a new instance.
  #take(canSuspend, host) {
    const instance = this.#instances[canSuspend] ?? new Instance(this.#module, canSuspend);
    this.#instances[canSuspend] = null;
    instance.host = host;
    return instance;
  }

  #answered(instance, canSuspend) {
    this.#instances[canSuspend] = instance;
    const answer = JSON.parse(instance.answer());
    if (answer.refused !== undefined) throw new GapilibError(answer.refused);
    return answer;
  }
}

function failed(instance, trap) {
  return new GapilibError(instance.answer() || String(trap), { cause: trap });
}

function encoded(files) {
  return Object.fromEntries(Object.entries(files).map(([path, content]) => [path, base64(content)]));
}

function decoded(answer) {
  const written = Object.entries(answer.files).map(([path, text]) => [path, bytes(text)]);
  return { ...answer, files: Object.fromEntries(written) };
}

/** Base64 of a string in UTF-8, or of bytes. */
export function base64(content) {
  const all = typeof content === "string" ? new TextEncoder().encode(content) : content;
  let text = "";
  // In parts: a call has room for some thousand arguments.
  for (let at = 0; at < all.length; at += 8192) {
    text += String.fromCharCode(...all.subarray(at, at + 8192));
  }
  return btoa(text);
}

/** The bytes of a text in base64. */
export function bytes(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}
