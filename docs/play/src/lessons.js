// The lessons: what is passed is remembered in this browser.

const at = (id) => document.getElementById(id);

export const store = {
  get(key, otherwise) {
    try { return JSON.parse(localStorage.getItem("gapilib-" + key)) ?? otherwise; } catch { return otherwise; }
  },
  set(key, value) {
    try { localStorage.setItem("gapilib-" + key, JSON.stringify(value)); } catch { /* private windows keep nothing */ }
  },
};

export class Lessons {
  #engine;
  #work;
  #lesson = null;
  #hints = 0;

  /** `work` has `files()`, `open(work)`, `onpassed()` and `last()`, the number of the last lesson. */
  constructor(engine, work) {
    this.#engine = engine;
    this.#work = work;
    at("check").addEventListener("click", () => this.#check());
    at("hint").addEventListener("click", () => this.#hint());
    at("solution").addEventListener("click", () => this.#solution());
    at("reset").addEventListener("click", () => { store.set("lesson-" + this.#lesson.number, null); this.open(this.#lesson); });
  }

  static passed() {
    return store.get("passed", []);
  }

  /** Opens a lesson as the learner has left it. */
  open(lesson) {
    const own = { files: { [lesson.file]: lesson.text, ...Object.fromEntries(lesson.companions) }, main: lesson.file };
    this.#work.open({ ...own, files: { ...own.files, ...store.get("lesson-" + lesson.number, {}) }, lesson: lesson.number });
    this.enter(lesson);
  }

  /** The lesson that the files on the page belong to, if they do to one. */
  enter(lesson) {
    this.#lesson = lesson;
    this.#hints = 0;
    at("lesson").hidden = !lesson;
    if (!lesson) return;
    at("lesson-title").textContent = `Lesson ${lesson.number}: ${lesson.title}`;
    this.#say("The comments in the script say what to do. Change it, run it, and press Check.");
  }

  /** Keeps what the learner has written. */
  keep(files) {
    if (this.#lesson) store.set("lesson-" + this.#lesson.number, files);
  }

  async #check() {
    const { number, file } = this.#lesson, { [file]: text, ...others } = this.#work.files();
    const names = this.#lesson.companions.map(([name]) => name);
    const companions = Object.entries(others).filter(([name, content]) => names.includes(name) && typeof content === "string");
    this.#say("Checking ...");
    at("check").disabled = true;
    try {
      const { passed, text: said } = await this.#engine.ask("check", { lesson: number, text, companions });
      this.#say((passed ? `Lesson ${number} is passed.\n` : `Lesson ${number} is not passed yet.\n`) + said, passed);
      if (passed) store.set("passed", [...new Set([...Lessons.passed(), number])]);
      if (passed) this.#work.onpassed();
    } catch (error) {
      this.#say(String(error.message));
    }
    at("check").disabled = false;
  }

  #hint() {
    const { hints } = this.#lesson;
    this.#hints = Math.min(this.#hints + 1, hints.length);
    this.#say(hints.slice(0, this.#hints).map((hint, k) => `Hint ${k + 1} of ${hints.length}: ${hint}`).join("\n"));
  }

  #solution() {
    this.#say("");
    for (const [gap, filled] of this.#lesson.solution) {
      const part = (title, text) => {
        const pre = document.createElement("pre");
        pre.textContent = text.trim();
        pre.tabIndex = 0;
        at("lesson-said").append(title, pre);
      };
      part("Replace", gap);
      part("with", filled);
    }
  }

  #say(text, passed = false) {
    at("lesson-said").textContent = text;
    at("lesson-said").className = passed ? "passed" : "";
    at("next-lesson").hidden = !passed || this.#lesson.number === this.#work.last();
  }
}
