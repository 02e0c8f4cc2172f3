// What `gapilib.js` and the module that `build` makes do in node: `node --test test.mjs`.
//
// The transcripts of `tests/transcripts` are those that the native library is tested with, and must
// be the same to the byte.

import { load, GapilibError } from "./gapilib.js";
import { readdirSync, readFileSync } from "node:fs";
import { join, relative } from "node:path";
import { test } from "node:test";
import assert from "node:assert/strict";
import { gzipSync } from "node:zlib";

const project = join(import.meta.dirname, "../..");
const folders = join(project, "tests/transcripts");
const target = process.env.CARGO_TARGET_DIR ?? join(project, "target");
const web = process.env.GAPILIB_WEB_FOLDER ?? join(target, "web");
const binary = readFileSync(join(web, "gapilib.wasm"));
const gapilib = await load(binary);

/** Transcripts that cannot be the same, with the reason. */
const SKIPPED = {
  "experiments/plots": "the module draws SVG only, not PNG (feature `pictures`)",
  "strings/too_long": "a length of more than 32 bits has another error: addresses have 32 bits",
};

/** These two test what a script may not do. */
const NOT_WRITING = ["permissions", "external_files"];

/** All files below a folder whose path pleases, as `run` wants them. */
function filesOf(folder, base, pleases = () => true) {
  const files = {};
  for (const entry of readdirSync(folder, { withFileTypes: true, recursive: true })) {
    const path = join(entry.parentPath, entry.name);
    if (entry.isFile() && pleases(path)) files[relative(base, path)] = readFileSync(path);
  }
  return files;
}

test("the module is at most 4 MB, compressed", () => {
  const compressed = gzipSync(binary, { level: 9 }).length;
  console.log(`${binary.length} bytes, compressed ${compressed}`);
  assert.ok(compressed <= 4e6);
});

test("a model decays as its exact solution does", () => {
  const script = `model Decay
      parameter Real k = 1;
      Real x(start = 1, fixed = true);
    equation
      der(x) = -k*x;
    end Decay;
    translateModel("Decay")
    k = 2
    simulateModel("Decay", stopTime = 1, tolerance = 1e-8, resultFile = "decay")
    x = readTrajectory("decay.mat", {"x"}, 501)
    print(String(x[1,end], significantDigits = 16))`;
  const run = gapilib.run("decay.mos", { "decay.mos": script });
  assert.equal(run.exit_code, 0, run.errors);
  const last = Number(run.output.trim().split("\n").at(-1));
  assert.ok(Math.abs(last - Math.exp(-2)) < 1e-6, run.output);
  assert.ok(Object.keys(run.files).some((name) => name.endsWith("decay.mat")));
});

test("a wrong script is an error with its place", () => {
  const run = gapilib.run("wrong.mos", { "wrong.mos": "x = 1\ny = x + missing\n" });
  assert.equal(run.exit_code, 1);
  assert.match(run.errors, /error\[.*missing[^]*wrong\.mos:2:9/);
});

test("a wrong request is refused, and the next one is answered", () => {
  assert.throws(() => gapilib.run("a.mos", {}, { write: 3 }), GapilibError);
  assert.throws(() => gapilib.ask({ nonsense: {} }), GapilibError);
  assert.match(gapilib.run("a.mos", { "a.mos": "print(\"again\")" }).output, /again/);
});

test("endless recursion is an error, and the next script is answered", () => {
  const script = "function f input Real x; output Real y; algorithm y := f(x + 1); end f;\nf(1)\n";
  const run = gapilib.run("deep.mos", { "deep.mos": script });
  assert.match(run.errors, /error\[.*nested too deeply/);
  assert.match(gapilib.run("a.mos", { "a.mos": "print(\"again\")" }).output, /again/);
});

test("a panic is an error with its message, and the next script is answered", () => {
  // The module asks its host for nothing while it makes room for a request: none has so many bytes.
  const host = { monotonic: () => 0, unix: () => 0, poll: () => 0, next_line: () => 0, send() {} };
  const { exports } = new WebAssembly.Instance(new WebAssembly.Module(binary), { host });
  assert.throws(() => exports.request(-1), WebAssembly.RuntimeError);
  const place = new Uint8Array(exports.memory.buffer, exports.answer() >>> 0, exports.answer_length() >>> 0);
  assert.match(new TextDecoder().decode(place), /panicked at.*[^]*capacity overflow/);
});

/** The search of the guide's first chapter. */
const chapter = readFileSync(join(project, "docs/src/first_fit.md"), "utf8");
const search = Object.fromEntries([...chapter.matchAll(/^```\w+,file=(\S+)\n([^]*?)^```/gm)].map(([, name, text]) => [name, text]));

test("a run sends its generations, and its steps make a page", async () => {
  const events = [];
  const host = { send: (event) => events.push(event), poll: () => 0, nextLine: () => null };
  const run = await gapilib.start("fit.mos", search, {}, host);
  assert.equal(run.exit_code, 0, run.errors);
  const printed = events.map(({ print }) => print ?? "").join("");
  assert.equal(printed, run.output);
  assert.ok(events.some(({ view }) => view?.progress.done >= 1 && view.fitted.length === 1));
  assert.ok(!Object.keys(run.files).some((name) => name.endsWith("run.trace")));
  assert.match(await gapilib.steps(), /Generation|step by step/);
  const changes = [{ generation: 3, statement: "F_Mut := 0.9" }];
  const changed = await gapilib.start("fit.mos", search, { changes, compare: true }, host);
  assert.notEqual(changed.output.replace(/time .*/, ""), run.output.replace(/time .*/, ""));
  assert.match(await gapilib.steps(), /"statement":"F_Mut := 0.9"/);
});

test("a run is stopped, and changed while it goes on", async () => {
  const typed = [], lines = ["F_Mut := 0.9"];
  // Every script takes longer than the first look for messages in a run that never ends by itself.
  const endless = { ...search, "fit.mos": search["fit.mos"].replace(/N_Cycle = \d+/, "N_Cycle = 1000000") };
  assert.notEqual(endless["fit.mos"], search["fit.mos"]);
  let looks = 0;
  const host = {
    send: (event) => event.typed && typed.push(event.typed),
    poll: () => (++looks > 5 ? 1 : lines.length > 0 ? 2 : 0),
    nextLine: () => lines.shift() ?? null,
  };
  const run = await gapilib.start("fit.mos", endless, {}, host);
  assert.equal(run.exit_code, 130);
  assert.equal(typed.length, 1);
  assert.ok(typed[0].generation >= 1 && typed[0].statement === "F_Mut := 0.9");
  const last = await gapilib.start("fit.mos", endless, { last: 7 }, { ...host, poll: () => 0 });
  assert.match(last.output, /in 7 generations/);
});

test("a change that cannot be is refused, and the run continues", async () => {
  const lines = ["garbage (", "F_mut := 0.5", "F_Mut := 0,5", "F_Mut := 7", "F_Mut := 0.5"], typed = [];
  const count = lines.length;
  const host = { send: (event) => event.typed && typed.push(event.typed), poll: () => (lines.length > 0 ? 2 : 0), nextLine: () => lines.shift() ?? null };
  const long = { ...search, "fit.mos": search["fit.mos"].replace(/N_Cycle = \d+/, "N_Cycle = 2000") };
  const run = await gapilib.start("fit.mos", long, {}, host);
  assert.equal(run.exit_code, 0, run.errors);
  assert.equal(typed.length, count);
  assert.deepEqual(typed.map(({ refused }) => refused === null), [false, false, false, false, true]);
  assert.match(typed[1].refused, /did you mean `F_Mut`/);
  assert.match(typed[2].refused, /written with a point/);
  assert.match(typed[3].refused, /F_Mut is 7/);
  // The same where the engine cannot ask meanwhile.
  const again = { ...host, poll: () => 0 };
  typed.length = 0;
  const planned = await gapilib.start("fit.mos", search, { typed: [{ generation: 2, statement: "F_Mut := 7" }] }, again);
  assert.equal(planned.exit_code, 0, planned.errors);
  assert.match(typed[0].refused, /F_Mut is 7/);
});

test("a changed run that fails is not shown as a result", async () => {
  const host = { send() {}, poll: () => 0, nextLine: () => null };
  await gapilib.start("fit.mos", search, {}, host);
  for (const statement of ["F_Mut := 7", "F_Mut := -1", "F_mut := 0.5", "N_Parents := 1000"]) {
    const changes = [{ generation: 3, statement }];
    const changed = await gapilib.start("fit.mos", search, { changes, compare: true }, host);
    assert.equal(changed.exit_code, 1, statement);
    assert.ok(!(await gapilib.steps()).includes('"statement":'), statement);
  }
});

test("lessons do not speak of the command line", () => {
  for (const { number, text, introduction, hints, companions } of gapilib.ask({ lessons: {} })) {
    const { text: said } = gapilib.ask({ check: { lesson: number, text, companions } });
    for (const part of [introduction, said, ...hints]) assert.doesNotMatch(part, /--\w|gapi (lesson|teach|run)|\bsave\b/, `lesson ${number}`);
  }
});

test("lessons are there, and checked", () => {
  const lessons = gapilib.ask({ lessons: {} });
  assert.equal(lessons.length, 18);
  const [{ text, solution, companions }] = lessons;
  const solved = solution.reduce((text, [gap, filled]) => text.replace(gap, filled), text);
  assert.equal(gapilib.ask({ check: { lesson: 1, text, companions } }).passed, false);
  assert.equal(gapilib.ask({ check: { lesson: 1, text: solved, companions } }).passed, true);
});

for (const folder of readdirSync(folders)) {
  const inside = join(folders, folder);
  const scripts = readdirSync(inside).filter((name) => name.endsWith(".mos"));
  for (const script of scripts) {
    const stem = script.slice(0, -".mos".length);
    const name = `${folder}/${stem}`;
    test(`transcript ${name}`, { skip: SKIPPED[name] }, () => {
      const files = filesOf(inside, inside, (path) => !path.endsWith(".snap"));
      const run = gapilib.run(script, files, { write: !NOT_WRITING.includes(stem) });
      const snapshot = readFileSync(join(inside, `${stem}.snap`), "utf8");
      // Behind the head between the lines of dashes.
      const expected = snapshot.slice(snapshot.indexOf("\n---\n") + "\n---\n".length);
      assert.equal(`${run.transcript}[exit code ${run.exit_code}]\n`.trimEnd(), expected.trimEnd());
    });
  }
}

test("case 4.1 is identified with the settings of the paper", () => {
  const pleases = (path) => /\.(mos|mat|csv|mo|order)$/.test(path);
  const files = {
    ...filesOf(join(project, "scripts"), project, pleases),
    ...filesOf(join(project, "models"), project, pleases),
  };
  const before = performance.now();
  const run = gapilib.run("scripts/GAPILib.mos", files);
  const seconds = (performance.now() - before) / 1000;
  console.log(`case 4.1: ${seconds.toFixed(1)} s`);
  assert.equal(run.exit_code, 0, run.errors);
  // The digits of the README, which native runs print.
  const table = readFileSync(join(project, "README.md"), "utf8").split("\n");
  const rows = table.filter((line) => /^  (A|In|Io|B|R|Ilim) +\d/.test(line));
  assert.equal(rows.length, 6);
  for (const row of rows) assert.ok(run.output.includes(row.trimEnd()), row);
  const written = Object.keys(run.files).map((name) => name.replace(/^results\//, ""));
  for (const name of ["result.json", "report.html", "fit.svg"]) assert.ok(written.includes(name), name);
});
