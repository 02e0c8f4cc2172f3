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
const binary = readFileSync(join(target, "web/gapilib.wasm"));
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

test("a wrong script is told so, with its place", () => {
  const run = gapilib.run("wrong.mos", { "wrong.mos": "x = 1\ny = x + missing\n" });
  assert.equal(run.exit_code, 1);
  assert.match(run.errors, /error\[.*missing[^]*wrong\.mos:2:9/);
});

test("a wrong request is refused, and the next one is answered", () => {
  assert.throws(() => gapilib.run("a.mos", {}, { write: 3 }), GapilibError);
  assert.match(gapilib.run("a.mos", { "a.mos": "print(\"again\")" }).output, /again/);
});

test("endless recursion is an error, and the next script is answered", () => {
  const script = "function f input Real x; output Real y; algorithm y := f(x + 1); end f;\nf(1)\n";
  const run = gapilib.run("deep.mos", { "deep.mos": script });
  assert.match(run.errors, /error\[.*nested too deeply/);
  assert.match(gapilib.run("a.mos", { "a.mos": "print(\"again\")" }).output, /again/);
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
