// Runs GAPILib scripts with their files in memory, in a browser or in node.
//
//   const gapilib = await load(bytes);            // of gapilib_web.wasm, or a WebAssembly.Module
//   const run = gapilib.run("decay.mos", { "decay.mos": "print(\"hello\")" });
//   run.exit_code, run.output, run.errors, run.transcript, run.files["results/result.json"]
//
// A run is computed where it is called: in a page, call it from a worker.

/** The module is at fault, not the script. What was loaded starts anew with the next run. */
export class GapilibError extends Error {
  name = "GapilibError";
}

/** Compiles the module. `source` is its bytes or a `WebAssembly.Module`. */
export async function load(source) {
  const module = source instanceof WebAssembly.Module ? source : await WebAssembly.compile(source);
  return new Gapilib(module, await WebAssembly.instantiate(module, {}));
}

class Gapilib {
  #module;
  #instance;

  constructor(module, instance) {
    this.#module = module;
    this.#instance = instance;
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
    const encoded = Object.entries(files).map(([path, content]) => [path, base64(content)]);
    const answer = this.#ask({ script, files: Object.fromEntries(encoded), write });
    if (answer.refused !== undefined) throw new GapilibError(answer.refused);
    const written = Object.entries(answer.files).map(([path, text]) => [path, bytes(text)]);
    return { ...answer, files: Object.fromEntries(written) };
  }

  #ask(request) {
    const text = new TextEncoder().encode(JSON.stringify(request));
    // What a trap leaves behind is not to be trusted: the next run gets a new instance.
    const instance = this.#instance ?? new WebAssembly.Instance(this.#module, {});
    const { memory, request: room, run } = instance.exports;
    this.#instance = null;
    const place = room(text.length) >>> 0;
    new Uint8Array(memory.buffer, place, text.length).set(text);
    try {
      run();
    } catch (trap) {
      throw new GapilibError(answerOf(instance) || String(trap), { cause: trap });
    }
    this.#instance = instance;
    return JSON.parse(answerOf(instance));
  }
}

function answerOf({ exports: { memory, answer, answer_length } }) {
  const place = new Uint8Array(memory.buffer, answer() >>> 0, answer_length() >>> 0);
  return new TextDecoder().decode(place);
}

function base64(content) {
  const all = typeof content === "string" ? new TextEncoder().encode(content) : content;
  let text = "";
  // In parts: a call has room for some thousand arguments.
  for (let at = 0; at < all.length; at += 8192) {
    text += String.fromCharCode(...all.subarray(at, at + 8192));
  }
  return btoa(text);
}

function bytes(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}
