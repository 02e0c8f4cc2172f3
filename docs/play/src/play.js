// The page: files on one side, the run on the other.

import { EXAMPLES } from "examples";
import { Editor } from "./editor.js";
import { Engine } from "./engine.js";
import { Lessons } from "./lessons.js";
import { Live, short } from "./live.js";
import { appendLinked, places } from "./places.js";
import { archive, download, oneScript, packed, unpacked } from "./share.js";
import { advice, decodedText, placeOfCell } from "./tables.js";
import { digest, forget, fromShelf, keepWork, lastWork, putAside, shelf } from "./works.js";

const at = (id) => document.getElementById(id);
const engine = new Engine();
const live = new Live();
let lessons = [];
let work = { files: {}, main: "", shown: "" };
/** What the user has changed in the run that goes on or was the last: statements with generations. */
let typed = [];
let running = null;

const editor = new Editor(at("editor"), (text) => {
  work.files[work.shown] = text;
  save();
});
const trainer = new Lessons(engine, { files: () => work.files, open, restart, linked, onpassed: listWork, last: () => lessons.length });
at("next-lesson").addEventListener("click", () => opened("lesson " + (work.lesson + 1)));

/** A message for some seconds; `undo` is what its button does. */
function say(text, undo = null) {
  at("said").textContent = text;
  if (undo) {
    const button = document.createElement("button");
    button.id = "undo";
    button.textContent = "Undo";
    button.addEventListener("click", () => { at("said").replaceChildren(); undo(); });
    at("said").append(" ", button);
  }
  clearTimeout(say.timer);
  say.timer = setTimeout(() => at("said").replaceChildren(), undo ? 20000 : 6000);
}
function status(text) { at("status").textContent = text; }

// ---- Files -------------------------------------------------------------------------------------

/** Opens files: an example, a lesson, what a link holds. What was on the page and has been changed is put
 * aside first. */
function open(next) {
  // A lesson is kept as the learner has left it.
  const before = work, isKept = work.lesson && next.lesson !== work.lesson;
  const aside = isChanged() && !isKept ? putAside({ ...work, title: titleOf(work) }) : undefined;
  place(next);
  listWork();
  if (aside === undefined) return;
  const where = aside === null ? "This browser keeps nothing" : "Your work is kept: Open, Your work";
  say(`${where}.`, () => {
    if (aside !== null) forget(aside);
    place(before);
    listWork();
  });
}
/** Puts files on the page in place of those that are there; a run of these ends. */
function place(next) {
  if (running) {
    engine.end();
    status("Ready.");
    say("The run ended: other files were opened.");
  }
  work = { ...next, files: { ...next.files }, shown: next.shown ?? next.edit ?? next.main };
  work.opened = next.opened ?? digest(work.files);
  clearResults();
  editor.clear();
  trainer.enter(lessons.find(({ number }) => number === next.lesson) ?? null);
  show(work.shown);
  save();
  showTask();
}
/** A lesson as it was at the beginning; the learner's version is put aside. */
function restart(next) {
  const before = work;
  const aside = isChanged() ? putAside({ ...work, title: titleOf(work) }) : undefined;
  place(next);
  listWork();
  if (aside !== undefined) say("The lesson is as it was at the beginning; your version is kept: Open, Your work.", () => { forget(aside); place(before); listWork(); });
}
const isChanged = () => work.main !== "" && digest(work.files) !== work.opened;
const titleOf = ({ title, lesson, main }) => title ?? (lesson ? `Lesson ${lesson}` : base(main));
function save() {
  if (work.lesson) trainer.keep(Object.fromEntries(Object.entries(work.files).filter(([, content]) => typeof content === "string")));
  showDownload();
  const isKept = keepWork(work);
  if (!isKept && !save.said) say("This browser does not keep your work when the page is closed: use Download.");
  save.said ||= !isKept;
}
/** The place that a lesson asks to change is in view. */
function showTask() {
  const text = work.files[work.shown], line = work.lesson ? text.split("\n").findIndex((line) => /<-|^Guess :=/.test(line)) + 1 : 0;
  if (line > 0) editor.look(line);
}
const isText = (path) => typeof work.files[path] === "string";
const base = (path) => path.slice(path.lastIndexOf("/") + 1);

function show(path) {
  work.shown = isText(path) ? path : work.main;
  editor.show(work.shown, work.files[work.shown] ?? "");
  const before = at("files").contains(document.activeElement);
  at("files").replaceChildren(...Object.keys(work.files).filter((file) => isText(file) && !/\.order$/.test(file)).map((file) => {
    const tab = document.createElement("button");
    tab.setAttribute("role", "tab");
    tab.setAttribute("aria-selected", file === work.shown);
    tab.setAttribute("aria-controls", "editor");
    tab.tabIndex = file === work.shown ? 0 : -1;
    tab.title = file;
    tab.textContent = base(file);
    tab.addEventListener("click", () => show(file));
    return tab;
  }));
  if (before) at("files").querySelector("[aria-selected=true]").focus();
  at("remove").hidden = work.shown === work.main;
  at("files").querySelector("[aria-selected=true]")?.scrollIntoView({ block: "nearest", inline: "nearest" });
}

/** Takes the file that is shown away; the main script stays. */
function removeShown() {
  const path = work.shown, content = work.files[path];
  if (path === work.main) return say("The main script stays; other files can be removed.");
  delete work.files[path];
  show(work.main);
  save();
  say(`${base(path)} is removed.`, () => { work.files[path] = content; show(path); save(); });
}

async function add(list) {
  for (const file of list) {
    if (file.size > 20e6) { say(`${file.name} is larger than 20 MB`); continue; }
    const folder = work.main.includes("/") ? work.main.slice(0, work.main.lastIndexOf("/") + 1) : "";
    const known = Object.keys(work.files).find((path) => base(path) === file.name);
    const path = known ?? folder + file.name;
    const isBinary = !/\.(mos?|csv|txt|toml|json)$/i.test(file.name);
    const bytes = new Uint8Array(await file.arrayBuffer()), before = work.files[path];
    work.files[path] = isBinary ? bytes : decodedText(bytes);
    if (!isBinary) show(path);
    const undo = before === undefined ? null : () => { work.files[path] = before; editor.clear(); show(path); save(); };
    const replaced = undo ? " It replaces the file of this name." : "";
    if (isBinary) say(`${file.name} is here; scripts can read it.${replaced}`, undo);
    else if (/\.(csv|txt)$/i.test(file.name)) {
      const { text, isWarning } = advice(file.name, work.files[path], work.files);
      say((isWarning ? "Warning: " : "") + text + replaced, undo);
    } else if (undo) say(`${file.name} is here.${replaced}`, undo);
    if (/\.mos$/i.test(file.name) && !known && !work.files[work.main]) work.main = path;
  }
  save();
}

// ---- A run -------------------------------------------------------------------------------------

function select(tab) {
  for (const one of at("tabs").children) {
    const isIt = one === tab;
    one.setAttribute("aria-selected", isIt);
    one.tabIndex = isIt ? 0 : -1;
    at(one.getAttribute("aria-controls")).hidden = !isIt;
  }
}
function view(name) {
  document.body.dataset.view = name;
  at("to-edit").setAttribute("aria-selected", name === "edit");
  at("to-see").setAttribute("aria-selected", name === "see");
}
/** What the buttons can do now; the focus does not stay on one that can do nothing. */
function busy(is) {
  const focused = document.activeElement;
  at("run").disabled = at("run-here").disabled = is;
  at("stop").disabled = !is;
  at("pause").disabled = !is || !engine.suspends;
  at("pause").textContent = "Pause";
  at("change").hidden = !is;
  if (is) forgetChanges();
  if (is && (focused === at("run") || focused === at("run-here"))) at("stop").focus();
  if (!is && [at("stop"), at("pause"), document.body].includes(focused)) at("run").focus();
}
/** What became of the changes of a run, below their field: a line for each, the latest first. A statement
 * that waits has its line already; what is said of the field itself belongs to no statement. */
function changeSaid(text, kind, statement = null) {
  const all = [...at("change-said").children];
  all.filter((line) => line.statement === null).forEach((line) => line.remove());
  const waits = kind !== "waiting" && all.findLast((line) => line.className === "waiting" && line.statement === statement);
  const line = waits || document.createElement("p");
  line.statement = statement;
  line.className = kind;
  line.textContent = text;
  if (!waits) at("change-said").prepend(line);
  at("change-said").tabIndex = 0;
  at("statement").setAttribute("aria-invalid", kind === "refused");
}
function forgetChanges() {
  at("change-said").replaceChildren();
  at("change-said").removeAttribute("tabindex");
  at("statement").setAttribute("aria-invalid", false);
}

/** Paths as the page shows them: the files of a run are in memory. */
const here = (text) => text.replaceAll("/memory/", "");
const LISTENERS = {
  print: (text) => write(here(text), ""),
  eprint: (text) => write(here(text), "errors"),
  view(picture) {
    live.add(picture);
    const { done, total, best } = picture.progress;
    const unit = live.unit();
    status(`${unit[0].toUpperCase()}${unit.slice(1)} ${done}${total ? " of " + total : ""}, best ${short(best)}`);
  },
  typed({ generation, statement, refused }) {
    const known = typed.findIndex((change) => change.generation === generation && change.statement === statement);
    if (refused !== null) {
      if (known >= 0) typed.splice(known, 1);
      // To be put right, where nothing else has been begun.
      if (!at("statement").value) at("statement").value = statement;
      return changeSaid(`Not changed by ${statement}: ${refused.replace(/[.?]$/, "")}. The run continues.`, "refused", statement);
    }
    if (known < 0) typed.push({ generation, statement });
    if (at("statement").value.trim() === statement) at("statement").value = "";
    changeSaid(`${statement} from generation ${generation} on.`, "done", statement);
  },
  paused: () => status("Paused. Statements that you apply take effect from this generation on."),
};
engine.onevent = (event) => Object.entries(event).forEach(([what, value]) => LISTENERS[what]?.(value));

/** Results belong to the files that are shown. */
function clearResults() {
  live.clear();
  for (const id of ["text", "written", "shown-file"]) at(id).replaceChildren();
  at("steps").replaceChildren(at("no-steps"));
  at("no-steps").hidden = at("no-results").hidden = false;
}

/** Runs the main script; `options` as `gapilib.js` has them. */
async function run(options = {}) {
  view("see");
  if (!options.compare) {
    clearResults();
    typed = [...(options.typed ?? [])];
    select(at("tab-live"));
  }
  status("Loading ...");
  try {
    await engine.ready();
    busy(true);
    status("Running ...");
    const before = performance.now();
    running = engine.ask("run", { script: work.main, files: work.files, options });
    const answer = await running;
    if (options.compare) return answer;
    finished(answer, (performance.now() - before) / 1000);
    await showSteps(answer.exit_code !== 0);
  } catch (error) {
    if (error.message === "ended") return null;
    if (options.compare) return { exit_code: 1, errors: `error: ${error.message}` };
    status("The run failed.");
    write(`error: ${error.message}\n`, "errors");
    select(at("tab-output"));
  } finally {
    running = null;
    busy(false);
  }
}

function finished(answer, seconds) {
  const failed = answer.exit_code !== 0 && answer.exit_code !== 130;
  const time = `${seconds.toFixed(1)} s`;
  status(answer.stopped ? `Stopped in ${live.unit()} ${live.now()?.done ?? 0}, after ${time}.` : failed ? "The script ended with an error." : `Done in ${time}.`);
  results(answer.files);
  markErrors(answer.errors);
  if (failed || !live.now()?.done) select(at("tab-output"));
  live.ended();
}

/** The page of the steps, if something was recorded. */
async function showSteps(isQuiet) {
  let html;
  try {
    html = await engine.ask("steps");
  } catch {
    return;
  }
  const frame = document.createElement("iframe");
  frame.title = "The run, step by step";
  // Its forms are answered by its own script.
  frame.setAttribute("sandbox", "allow-scripts allow-forms");
  frame.srcdoc = html;
  at("no-steps").hidden = true;
  at("steps").replaceChildren(at("no-steps"), frame);
  if (!isQuiet && !live.now()) select(at("tab-steps"));
}
/** The page of the steps asks what would have been. */
async function whatIf({ generation, statement }) {
  const failed = (reason) => at("steps").querySelector("iframe")?.contentWindow.postMessage({ whatIfFailed: reason }, "*");
  if (running) return failed("a run is being computed; try again when it has ended.");
  status(`Running again with ${statement} from generation ${generation} on ...`);
  const answer = await run({ compare: true, changes: [...typed, { generation, statement }] });
  if (!answer) return;
  select(at("tab-steps"));
  if (answer.exit_code !== 0 && !answer.stopped) {
    const reason = /^error(?:\[[\w-]+\])?: (.*)/m.exec(answer.errors)?.[1] ?? "the changed run ended with an error";
    failed(reason);
    return status(`No comparison: ${reason}`);
  }
  await showSteps(false);
  status(`Compared: ${statement} from generation ${generation} on.`);
}

async function stop() {
  if (engine.suspends) return engine.send("stop");
  const done = live.now()?.done;
  engine.end();
  if (!done) return status("Stopped before the first generation.");
  say("This browser cannot stop a run gently: it is computed again up to this generation, for its report.");
  await run({ last: done, typed });
}
async function change(statement) {
  const isPaused = at("pause").textContent === "Resume";
  if (isPaused) {
    changeSaid(`${statement} is checked when the run resumes.`, "waiting", statement);
    at("statement").value = "";
  }
  if (engine.suspends) return engine.send("line", statement);
  const generation = (live.now()?.done ?? 0) + 1;
  engine.end();
  say(`This browser cannot change a run while it is computed: it is computed again, with ${statement} from generation ${generation} on.`);
  await run({ typed: [...typed, { generation, statement }] });
}
function pause() {
  const isPaused = at("pause").textContent === "Resume";
  engine.send(isPaused ? "resume" : "pause");
  at("pause").textContent = isPaused ? "Pause" : "Resume";
  if (isPaused) status("Running ...");
}

// ---- Output ------------------------------------------------------------------------------------

/** Appends text, line by line: an unfinished line goes on with the next text of its kind. */
function write(text, kind) {
  const lines = text.split("\n");
  lines.forEach((line, k) => {
    const last = at("text").lastElementChild;
    const open = last?.dataset.open === "true" && last.classList.contains(kind || "plain") ? last : null;
    if (k === lines.length - 1 && line === "") return;
    const element = open ?? document.createElement("span");
    showLine(element, (open?.textContent ?? "") + line, kind);
    element.dataset.open = String(k === lines.length - 1);
    if (!open) at("text").append(element);
  });
}
/** A line; places in files are links into the editor. Rows of tables and of source are not wrapped. */
function showLine(element, text, kind) {
  const gaps = text.trim().match(/ {2,}/g)?.length ?? 0;
  const isSource = /^\s*(\d+ )?[\u2500-\u257f]/.test(text);
  const layout = gaps > 1 || isSource ? "row" : gaps === 1 && text.startsWith("  ") ? "labelled" : "sentence";
  element.className = `${kind || "plain"} ${layout}`;
  element.replaceChildren();
  linked(element, text || "\u00a0");
}
/** Appends text to an element; places in files of the page are links into the editor. */
function linked(element, text) {
  appendLinked(element, text, ({ name, line, column, isCell }) => {
    const path = pathOf(name);
    return path && (() => goTo(path, line, isCell ? placeOfCell(work.files[path], line, column) : column));
  });
}
/** The file that a message means. */
function pathOf(name) {
  const wanted = name.replace(/^\/memory\//, "");
  return [wanted, ...Object.keys(work.files).filter((path) => path.endsWith("/" + wanted))].find(isText);
}
function goTo(path, line, column) {
  view("edit");
  show(path);
  editor.go(line, column);
}
/** Marks the errors in the editor where they are in the file that is shown. */
function markErrors(text) {
  const wrong = [];
  let head = null;
  for (const line of text.split("\n")) {
    const begins = /^(error|warning)(?:\[[\w-]+\])?: (.*)/.exec(line);
    if (begins) head = { severity: begins[1], message: begins[2] };
    if (!head) continue;
    const [place] = places(line);
    if (!place) continue;
    const path = pathOf(place.name), { column } = place;
    wrong.push({ ...head, path, line: place.line, column: place.isCell && path ? placeOfCell(work.files[path], place.line, column) : column });
    // A table's place is named in the sentence, the script's below it.
    if (!place.isCell) head = null;
  }
  editor.mark(wrong.filter(({ path }) => path === work.shown));
}

const KINDS = { html: "text/html", svg: "image/svg+xml", json: "application/json", csv: "text/csv", txt: "text/plain" };
function results(files) {
  at("no-results").hidden = Object.keys(files).length > 0;
  const button = ([path, bytes]) => {
    const item = document.createElement("li"), open = document.createElement("button");
    open.textContent = path.replace(/^results\//, "");
    open.addEventListener("click", () => showFile(path, bytes));
    item.append(open);
    return item;
  };
  at("written").replaceChildren(...Object.entries(files).sort(([a], [b]) => (b.endsWith("report.html") - a.endsWith("report.html")) || a.localeCompare(b)).map(button));
}
function showFile(path, bytes) {
  const kind = KINDS[path.slice(path.lastIndexOf(".") + 1)];
  const save = document.createElement("button");
  save.textContent = `Save ${base(path)}`;
  save.addEventListener("click", () => download(base(path), new Blob([bytes])));
  let shown = document.createElement("pre");
  if (kind === "text/html") {
    shown = document.createElement("iframe");
    shown.title = base(path);
    shown.setAttribute("sandbox", "allow-scripts");
    shown.srcdoc = new TextDecoder().decode(bytes);
  } else if (kind === "image/svg+xml") {
    shown = document.createElement("img");
    shown.alt = base(path);
    shown.src = "data:image/svg+xml," + encodeURIComponent(new TextDecoder().decode(bytes));
  } else if (kind) {
    shown.tabIndex = 0;
    shown.textContent = new TextDecoder().decode(bytes.subarray(0, 200000));
  } else shown.textContent = `${bytes.length} bytes`;
  at("shown-file").replaceChildren(save, shown);
}

// ---- Sharing -----------------------------------------------------------------------------------

async function share() {
  if (Object.keys(work.files).some((path) => !isText(path))) return say("A link holds text only; use Download for binary tables.");
  const { files, main, shown, lesson } = { ...work, shown: /\.mos?$/.test(work.shown) ? work.shown : work.main };
  const link = location.href.split("#")[0] + "#p=" + await packed({ files, main, shown, lesson });
  history.replaceState(null, "", link);
  const local = location.protocol === "file:" ? " It leads to this file on this computer: for others, use Download, or open the page from a web server." : "";
  try {
    await navigator.clipboard.writeText(link);
    say(`The link is in the clipboard (${link.length} characters); it holds all files.${local}`);
  } catch {
    say(`The link is in the address bar; it holds all files.${local}`);
  }
}
function save_files() {
  const script = oneScript(work.files, work.main), count = Object.keys(work.files).length;
  if (script !== null) {
    download(base(work.main), script);
    const what = count > 1 ? `${base(work.main)} holds all ${count} files. ` : "";
    return say(`${what}Run it with: gapi run ${base(work.main)}`);
  }
  download("problem.zip", archive(work.files));
  say(`problem.zip holds ${count} files. Unpack it, then: gapi run ${work.main}`);
}
/** Beside the button: what it gives. */
function showDownload() {
  const count = Object.keys(work.files).length;
  at("download-as").textContent = oneScript(work.files, work.main) === null ? `${count} files in an archive` : count > 1 ? `${count} files as one script` : "";
}

// ---- The beginning -----------------------------------------------------------------------------

function listWork() {
  const passed = Lessons.passed();
  const group = (title, options) => {
    const element = document.createElement("optgroup");
    element.label = title;
    element.append(...options.map(([text, value]) => new Option(text, value)));
    return element;
  };
  const mine = shelf();
  at("open").replaceChildren(
    new Option("an example or a lesson ...", ""),
    group("Examples", EXAMPLES.map(({ title }, k) => [title, "example " + k])),
    ...(mine.length ? [group("Your work", mine.map((entry) => [`${titleOf(entry)}, ${new Date(entry.time).toLocaleString([], { dateStyle: "short", timeStyle: "short" })}`, "work " + entry.id]))] : []),
    group("Lessons", lessons.map(({ number, title }) => [`${passed.includes(number) ? "\u2713" : "\u25cb"} ${number}. ${title}`, "lesson " + number])),
  );
  const example = EXAMPLES.findIndex(({ title }) => title === work.title);
  at("open").value = work.lesson ? "lesson " + work.lesson : example >= 0 ? "example " + example : "";
}
function opened(value) {
  const [kind, number] = value.split(" ");
  const mine = kind === "work" && fromShelf(Number(number));
  if (mine) open(mine);
  if (kind === "example") open(EXAMPLES[number]);
  if (kind === "lesson") trainer.open(lessons.find((lesson) => lesson.number === Number(number)));
  // Arrow keys go on from what is open.
  if ([...at("open").options].some((option) => option.value === value)) at("open").value = value;
  view("edit");
}
/** Arrow keys among tabs. */
function arrows(event) {
  const tabs = [...event.currentTarget.querySelectorAll("[role=tab]")];
  const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  const next = tabs[tabs.indexOf(document.activeElement) + step];
  if (!next) return;
  event.preventDefault();
  next.focus();
  next.click();
}

async function fromLink() {
  const { p, open: wanted } = Object.fromEntries(new URLSearchParams(location.hash.slice(1)));
  const shared = p && await unpacked(p);
  if (p && !shared) say("The link is damaged: it holds no files.");
  if (shared) {
    trainer.spare(shared);
    open(shared);
  }
  if (wanted) opened(wanted.replace("-", " "));
  return shared || wanted;
}

async function begin() {
  view("edit");
  place(lastWork() ?? EXAMPLES[0]);
  listWork();
  for (const id of ["run", "run-here"]) at(id).addEventListener("click", () => run());
  at("stop").addEventListener("click", stop);
  at("pause").addEventListener("click", pause);
  at("remove").addEventListener("click", removeShown);
  at("share").addEventListener("click", share);
  at("download").addEventListener("click", save_files);
  at("open").addEventListener("change", () => opened(at("open").value));
  at("add").addEventListener("change", () => add(at("add").files));
  at("to-edit").addEventListener("click", () => view("edit"));
  at("to-see").addEventListener("click", () => view("see"));
  at("change").addEventListener("submit", (event) => {
    event.preventDefault();
    const statement = at("statement").value.trim();
    if (statement) change(statement);
    else changeSaid("Write a statement, such as F_Mut := 0.5.", "refused");
  });
  const licences = document.getElementById("licences");
  if (licences) at("to-licences").href = URL.createObjectURL(new Blob([licences.textContent], { type: "text/plain" }));
  for (const tab of at("tabs").children) tab.addEventListener("click", () => select(tab));
  for (const list of ["tabs", "files", "views"]) at(list).addEventListener("keydown", arrows);
  document.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey) && !running) { event.preventDefault(); run(); }
  });
  addEventListener("message", ({ data, source }) => {
    const isOwn = source === at("steps").querySelector("iframe")?.contentWindow;
    if (isOwn && data?.whatIf) whatIf(data.whatIf);
  });
  addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("dropping"); });
  addEventListener("dragleave", () => document.body.classList.remove("dropping"));
  addEventListener("drop", (event) => { event.preventDefault(); document.body.classList.remove("dropping"); add(event.dataTransfer.files); });
  addEventListener("hashchange", fromLink);
  if (location.hash.startsWith("#p=")) await fromLink();
  // The module is fetched and compiled when the page has been painted.
  requestAnimationFrame(() => setTimeout(loadLessons));
}
async function loadLessons() {
  status("Loading ...");
  try {
    lessons = await engine.ask("lessons");
  } catch (error) {
    const instead = location.protocol === "file:"
      ? "open play.html, the page in one file, or serve this folder (python3 -m http.server)"
      : "reload the page; if that does not help, try a current Firefox or Chromium without extensions, which can block WebAssembly";
    return status(`The program cannot be loaded (${error.message}): ${instead}.`);
  }
  listWork();
  if (work.lesson) trainer.enter(lessons.find(({ number }) => number === work.lesson));
  showTask();
  if (!location.hash.startsWith("#p=")) await fromLink();
  status("Ready.");
  document.body.dataset.ready = "true";
}
begin();
