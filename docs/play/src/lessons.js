// The lessons: what is passed is remembered in this browser.

import { digest, putAside, store } from "./works.js";

const at = (id) => document.getElementById(id);

export class Lessons {
  #engine;
  #work;
  #lesson = null;
  #hints = 0;

  /** `work` has `files()`, `open(work)`, `restart(work)`, `linked(element, text)`, `onpassed()` and `last()`,
   * the number of the last lesson. */
  constructor(engine, work) {
    this.#engine = engine;
    this.#work = work;
    at("check").addEventListener("click", () => this.#check());
    at("lesson-more").addEventListener("click", () => this.#unfold(at("lesson-about").classList.contains("folded")));
    new ResizeObserver(() => Lessons.#offerMore()).observe(at("lesson-about"));
    at("hint").addEventListener("click", () => this.#hint());
    at("solution").addEventListener("click", () => this.#solution());
    at("reset").addEventListener("click", () => this.#work.restart({ ...Lessons.#shipped(this.#lesson), lesson: this.#lesson.number }));
  }

  static passed() {
    return store.get("passed", []);
  }

  static #shipped(lesson) {
    return { files: { [lesson.file]: lesson.text, ...Object.fromEntries(lesson.companions) }, main: lesson.file };
  }

  /** Opens a lesson as the learner has left it. */
  open(lesson) {
    const own = Lessons.#shipped(lesson);
    const files = { ...own.files, ...store.get("lesson-" + lesson.number, {}) };
    this.#work.open({ ...own, files, opened: digest(own.files), lesson: lesson.number });
  }

  /** Before a shared link replaces what the learner has written in a lesson, that is put aside. */
  spare({ lesson, main, files }) {
    const own = lesson && store.get("lesson-" + lesson, null);
    if (own && digest(own) !== digest(files)) putAside({ title: `Lesson ${lesson}`, files: own, main, lesson });
  }

  /** The lesson that the files on the page belong to, if they do to one. */
  enter(lesson) {
    this.#lesson = lesson;
    this.#hints = 0;
    at("lesson").hidden = !lesson;
    if (!lesson) return;
    at("lesson-title").textContent = `Lesson ${lesson.number}: ${lesson.title}`;
    // The task is the last paragraph of the comment that the script begins with; it is always in sight.
    const paragraphs = lesson.introduction.trim().split(/\n\s*\n/);
    const task = paragraphs.findIndex((part) => part.startsWith("Your task"));
    const joined = (part) => part.replace(/\n(?!\d\.)/g, " ");
    at("lesson-about").replaceChildren(...paragraphs.slice(1, task).map((part) => {
      const element = document.createElement("p");
      element.textContent = joined(part);
      return element;
    }));
    at("lesson-do").textContent = paragraphs.slice(task).map(joined).join("\n");
    at("lesson-task").hidden = task < 2;
    this.#unfold(false);
    this.#say("");
  }

  /** Shows all of what the lesson is about, or its beginning with a button for the rest. */
  #unfold(isWhole) {
    at("lesson-task").open = true;
    at("lesson-about").classList.toggle("folded", !isWhole);
    at("lesson-more").textContent = isWhole ? "Less" : "Read on";
    at("lesson-more").setAttribute("aria-expanded", isWhole);
    Lessons.#offerMore();
  }

  /** The button for the rest is there where there is a rest; a part that is not shown has no size yet. */
  static #offerMore() {
    const about = at("lesson-about");
    at("lesson-more").hidden = about.classList.contains("folded") && about.scrollHeight <= about.clientHeight + 1;
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
    const focused = document.activeElement;
    at("check").disabled = true;
    try {
      const { passed, text: said } = await this.#engine.ask("check", { lesson: number, text, companions });
      const { watch } = this.#lesson, steps = passed && watch ? `\n\nWatch ${watch}: press Run, then open Step by step.` : "";
      this.#say((passed ? `Lesson ${number} is passed.\n` : `Lesson ${number} is not passed yet.\n`) + said + steps, passed);
      if (passed) store.set("passed", [...new Set([...Lessons.passed(), number])]);
      if (passed) this.#work.onpassed();
    } catch (error) {
      this.#say(String(error.message));
    }
    at("check").disabled = false;
    if (focused === at("check")) focused.focus();
  }

  #hint() {
    const { hints } = this.#lesson;
    this.#hints = Math.min(this.#hints + 1, hints.length);
    this.#say(hints.slice(0, this.#hints).map((hint, k) => `Hint ${k + 1} of ${hints.length}: ${hint}`).join("\n"));
  }

  #solution() {
    this.#say("");
    at("lesson-task").open = false;
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
    at("lesson-said").replaceChildren();
    // What is said has the place of the explanation, which opens again; who has passed has no task.
    if (text) at("lesson-task").open = false;
    at("lesson-do").hidden = passed;
    if (text) this.#work.linked(at("lesson-said"), text);
    if (text) at("lesson-said").scrollIntoView({ block: "nearest" });
    at("lesson-said").className = passed ? "passed" : "";
    at("next-lesson").hidden = !passed || this.#lesson.number === this.#work.last();
  }
}
