// The page: files on one side, the run on the other.

import { EXAMPLES } from "examples";
import { Editor } from "./editor.js";
import { Engine } from "./engine.js";
import { Lessons, store } from "./lessons.js";
import { Live, short } from "./live.js";
import { archive, download, oneScript, packed, unpacked } from "./share.js";

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
const trainer = new Lessons(engine, { files: () => work.files, open, onpassed: listWork, last: () => lessons.length });
at("next-lesson").addEventListener("click", () => {
  at("open").value = "lesson " + (work.lesson + 1);
  opened(at("open").value);
});

function say(text) {
  at("said").textContent = text;
  clearTimeout(say.timer);
  say.timer = setTimeout(() => { at("said").textContent = ""; }, 5000);
}
function status(text) { at("status").textContent = text; }

// ---- Files -------------------------------------------------------------------------------------

/** Opens files: an example, a lesson, what a link holds. */
function open(next) {
  work = { ...next, files: { ...next.files }, shown: next.shown ?? next.edit ?? next.main };
  clearResults();
  editor.clear();
  trainer.enter(lessons.find(({ number }) => number === next.lesson) ?? null);
  show(work.shown);
  save();
}
function save() {
  // Binary tables are numbers in JSON: too large to be kept, and they are not edited.
  const texts = Object.fromEntries(Object.entries(work.files).filter(([, content]) => typeof content === "string"));
  if (work.lesson) trainer.keep(texts);
  store.set("work", { ...work, files: texts });
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
  at("files").querySelector("[aria-selected=true]")?.scrollIntoView({ block: "nearest", inline: "nearest" });
}

async function add(list) {
  for (const file of list) {
    if (file.size > 20e6) { say(`${file.name} is larger than 20 MB`); continue; }
    const folder = work.main.includes("/") ? work.main.slice(0, work.main.lastIndexOf("/") + 1) : "";
    const known = Object.keys(work.files).find((path) => base(path) === file.name);
    const path = known ?? folder + file.name;
    const isBinary = !/\.(mos?|csv|txt|toml|json)$/i.test(file.name);
    work.files[path] = isBinary ? new Uint8Array(await file.arrayBuffer()) : await file.text();
    if (!isBinary) show(path);
    else say(`${file.name} is here; scripts can read it.`);
    if (/\.csv$/i.test(file.name)) say(`${file.name} is here. Name it in the line with Exp_Adq_SISO: columns ${columns(work.files[path])}.`);
    if (/\.mos$/i.test(file.name) && !known && !work.files[work.main]) work.main = path;
  }
  save();
}
const columns = (text) => text.split(/\r?\n/, 1)[0].slice(0, 100);

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
/** What the buttons can do now. */
function busy(is) {
  at("run").disabled = at("run-here").disabled = is;
  at("stop").disabled = !is;
  at("pause").disabled = !is || !engine.suspends;
  at("pause").textContent = "Pause";
  at("change").hidden = !is;
}

/** Paths as the page shows them: the files of a run are in memory. */
const here = (text) => text.replaceAll("/memory/", "");
const LISTENERS = {
  print: (text) => write(here(text), ""),
  eprint: (text) => write(here(text), "errors"),
  view(picture) {
    live.add(picture);
    const { done, total, best } = picture.progress;
    status(`Generation ${done}${total ? " of " + total : ""}, best ${short(best)}`);
  },
  typed(change) {
    typed.push(change);
    say(`${change.statement} from generation ${change.generation} on.`);
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
    typed = options.changes ?? [];
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
    if (options.compare) return await showSteps(false);
    finished(answer, (performance.now() - before) / 1000);
    await showSteps(answer.exit_code !== 0);
  } catch (error) {
    if (error.message === "ended") return;
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
  status(failed ? "The script ended with an error." : `Done in ${seconds.toFixed(1)} s.`);
  results(answer.files);
  markErrors(answer.errors);
  if (failed || !live.now()) select(at("tab-output"));
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
  status(`Running again with ${statement} from generation ${generation} on ...`);
  await run({ compare: true, changes: [...typed, { generation, statement }] });
  select(at("tab-steps"));
  status(`Compared: ${statement} from generation ${generation} on.`);
}

async function stop() {
  if (engine.suspends) return engine.tell("stop");
  const done = live.now()?.done;
  engine.end();
  if (!done) return status("Stopped before the first generation.");
  say("This browser cannot stop a run gently: it is computed again up to this generation, for its report.");
  await run({ last: done, changes: typed });
}
async function change(statement) {
  if (engine.suspends) return engine.tell("line", statement);
  const generation = (live.now()?.done ?? 0) + 1;
  engine.end();
  say(`This browser cannot change a run that goes on: it is computed again, with ${statement} from generation ${generation} on.`);
  await run({ changes: [...typed, { generation, statement }] });
}
function pause() {
  const isPaused = at("pause").textContent === "Resume";
  engine.tell(isPaused ? "resume" : "pause");
  at("pause").textContent = isPaused ? "Pause" : "Resume";
  if (isPaused) status("Running ...");
}

// ---- Output ------------------------------------------------------------------------------------

const PLACE = /([\w.\-/]+\.mos?):(\d+):(\d+)/g;
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
  let from = 0;
  for (const found of text.matchAll(PLACE)) {
    const path = pathOf(found[1]);
    if (!path) continue;
    const link = document.createElement("a");
    link.href = "#";
    link.textContent = found[0];
    link.addEventListener("click", (event) => { event.preventDefault(); goTo(path, Number(found[2]), Number(found[3])); });
    element.append(text.slice(from, found.index), link);
    from = found.index + found[0].length;
  }
  element.append(text.slice(from) || "\u00a0");
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
    const place = new RegExp(PLACE.source).exec(line);
    if (place && head) {
      wrong.push({ ...head, path: pathOf(place[1]), line: Number(place[2]), column: Number(place[3]) });
      head = null;
    }
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
  const { files, main, shown, lesson } = work;
  const link = location.href.split("#")[0] + "#p=" + await packed({ files, main, shown, lesson });
  history.replaceState(null, "", link);
  try {
    await navigator.clipboard.writeText(link);
    say(`The link is in the clipboard (${link.length} characters); it holds all files.`);
  } catch {
    say("The link is in the address bar; it holds all files.");
  }
}
function save_files() {
  const script = oneScript(work.files, work.main);
  if (script !== null) {
    download(base(work.main), script);
    return say(`Run it with: gapi run ${base(work.main)}`);
  }
  download("problem.zip", archive(work.files));
  say(`Unpack it, then: gapi run ${work.main}`);
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
  const chosen = at("open").value;
  at("open").replaceChildren(
    new Option("an example or a lesson ...", ""),
    group("Examples", EXAMPLES.map(({ title }, k) => [title, "example " + k])),
    group("Lessons", lessons.map(({ number, title }) => [`${passed.includes(number) ? "\u2713" : "\u25cb"} ${number}. ${title}`, "lesson " + number])),
  );
  at("open").value = chosen;
}
function opened(value) {
  const [kind, number] = value.split(" ");
  if (kind === "example") open(EXAMPLES[number]);
  if (kind === "lesson") trainer.open(lessons.find((lesson) => lesson.number === Number(number)));
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
  const linked = p && await unpacked(p);
  if (p && !linked) say("The link is damaged: it holds no files.");
  if (linked) open(linked);
  if (wanted) at("open").value = wanted.replace("-", " ");
  if (wanted) opened(wanted.replace("-", " "));
  return linked || wanted;
}

async function begin() {
  view("edit");
  listWork();
  open(store.get("work", null) ?? EXAMPLES[0]);
  for (const id of ["run", "run-here"]) at(id).addEventListener("click", () => run());
  at("stop").addEventListener("click", stop);
  at("pause").addEventListener("click", pause);
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
  });
  for (const tab of at("tabs").children) tab.addEventListener("click", () => select(tab));
  for (const list of ["tabs", "files", "views"]) at(list).addEventListener("keydown", arrows);
  document.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey) && !running) { event.preventDefault(); run(); }
  });
  addEventListener("message", ({ data, source }) => {
    const isOwn = source === at("steps").querySelector("iframe")?.contentWindow;
    if (isOwn && data?.whatIf && !running) whatIf(data.whatIf);
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
    return status(`The program cannot be loaded: ${error.message}`);
  }
  listWork();
  if (work.lesson) trainer.enter(lessons.find(({ number }) => number === work.lesson));
  if (!location.hash.startsWith("#p=")) await fromLink();
  status("Ready.");
  document.body.dataset.ready = "true";
}
begin();
