// The worker, seen from a page: requests as promises, events, and what to do when a run must be
// stopped in an engine that cannot suspend it.

/** Where the worker's text and the module come from: files beside the page, or the page itself. */
function sources() {
  const inline = document.getElementById("worker-source");
  if (!inline) {
    const own = document.currentScript?.src ?? globalThis.PLAY_BASE ?? location.href;
    return { worker: new URL("worker.js", own).href, module: () => new URL("gapilib.wasm.gz", own).href };
  }
  const packed = document.getElementById("module").textContent.trim();
  const worker = URL.createObjectURL(new Blob([inline.textContent], { type: "text/javascript" }));
  return { worker, module: () => Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0)).buffer };
}

const SOURCES = sources();

/** Answers requests in a worker of its own, which is made when it is first needed. */
export class Engine {
  #worker = null;
  #waiting = new Map();
  #next = 0;
  #loaded = null;
  /** Whether a run can be stopped and changed while it goes on; known when `ready` is fulfilled. */
  suspends = false;
  /** Gets the events of a run. */
  onevent = () => {};

  /** The worker with the module in it. */
  ready() {
    this.#loaded ??= this.#begin();
    return this.#loaded;
  }

  async #begin() {
    this.#worker = new Worker(SOURCES.worker);
    this.#worker.onmessage = ({ data }) => this.#heard(data);
    this.#worker.onerror = (error) => this.#fail(error.message ?? "the worker cannot be started");
    const { suspends } = await this.#request("load", SOURCES.module());
    this.suspends = suspends;
  }

  #heard({ event, id, answer, failed }) {
    if (event) return this.onevent(event);
    const waiting = this.#waiting.get(id);
    this.#waiting.delete(id);
    if (failed === undefined) waiting?.done(answer);
    else waiting?.fail(new Error(failed));
  }

  #fail(message) {
    for (const { fail } of this.#waiting.values()) fail(new Error(message));
    this.#waiting.clear();
  }

  #request(what, value) {
    const id = this.#next++;
    const answer = new Promise((done, fail) => this.#waiting.set(id, { done, fail }));
    this.#worker.postMessage({ id, what, value });
    return answer;
  }

  /** Asks `run`, `steps`, `lessons` or `check`. */
  async ask(what, value) {
    await this.ready();
    return this.#request(what, value);
  }

  /** Sends a run that continues `stop`, `pause`, `resume` or `line`. */
  send(what, value) {
    this.#worker?.postMessage({ what, value });
  }

  /** Ends the worker with what it does; the next request begins a new one. */
  end() {
    this.#worker?.terminate();
    this.#worker = this.#loaded = null;
    this.#fail("ended");
  }
}
