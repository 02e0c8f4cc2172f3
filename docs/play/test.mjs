// The page in browsers: `node --test docs/play/test.mjs`, behind `docs/play/build`.
//
// Chromium and Firefox are found on the path, or named by GAPILIB_CHROMIUM and GAPILIB_FIREFOX; which
// of them is missing is said. The transcripts are those that the native library is tested with.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { createServer } from "node:http";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, unlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { extname, join, relative } from "node:path";
import { after, before, describe, test } from "node:test";
import { pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";
import puppeteer from "puppeteer-core";

const here = import.meta.dirname, project = join(here, "../..");
const target = process.env.CARGO_TARGET_DIR ?? join(project, "target");
const web = process.env.GAPILIB_WEB_FOLDER ?? join(target, "web");
const book = join(target, "book");
const pictures = join(web, "screenshots");
mkdirSync(pictures, { recursive: true });

/** Transcripts that cannot be the same, with the reason. */
const SKIPPED = {
  "experiments/plots": "the module draws SVG only, not PNG (feature `pictures`)",
  "strings/too_long": "a length of more than 32 bits has another error: addresses have 32 bits",
};
/** These two test what a script may not do. */
const NOT_WRITING = ["permissions", "external_files"];

function program(variable, names) {
  if (process.env[variable]) return process.env[variable];
  const folders = (process.env.PATH ?? "").split(":");
  return names.flatMap((name) => folders.map((folder) => join(folder, name))).find(existsSync);
}
const BROWSERS = [
  { name: "chromium", path: program("GAPILIB_CHROMIUM", ["chromium", "chromium-browser", "google-chrome"]), options: { args: ["--no-sandbox"] } },
  { name: "firefox", path: program("GAPILIB_FIREFOX", ["firefox-esr", "firefox"]), options: { browser: "firefox" } },
];

const KINDS = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };
/** What an engine without JavaScript Promise Integration lacks. */
const WITHOUT_SUSPENDING = "delete WebAssembly.Suspending; delete WebAssembly.promising;\n";
/** A server that knows nothing but files, with the page in `play`, as beside the book; below `plain` an
 * engine cannot suspend WebAssembly. */
async function serve(folder) {
  const server = createServer((request, response) => {
    const asked = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    const isPlain = asked.startsWith("/plain/");
    const path = asked.startsWith("/play/") ? join(web, asked) : join(folder, isPlain ? asked.slice("/plain".length) : asked);
    if (!existsSync(path)) return response.writeHead(404).end();
    const patch = isPlain && asked.endsWith("/worker.js") ? WITHOUT_SUSPENDING : "";
    response.writeHead(200, { "content-type": KINDS[extname(path)] ?? "application/octet-stream" }).end(Buffer.concat([Buffer.from(patch), readFileSync(path)]));
  });
  await new Promise((listening) => server.listen(0, "localhost", listening));
  return server;
}

function transcripts() {
  const folders = join(project, "tests/transcripts"), found = [];
  for (const folder of readdirSync(folders)) {
    const inside = join(folders, folder), files = {};
    for (const entry of readdirSync(inside, { withFileTypes: true, recursive: true })) {
      const path = join(entry.parentPath, entry.name);
      if (entry.isFile() && !path.endsWith(".snap")) files[relative(inside, path)] = readFileSync(path).toString("base64");
    }
    for (const script of readdirSync(inside).filter((name) => name.endsWith(".mos"))) {
      const stem = script.slice(0, -".mos".length), name = `${folder}/${stem}`;
      const snapshot = readFileSync(join(inside, `${stem}.snap`), "utf8");
      const expected = snapshot.slice(snapshot.indexOf("\n---\n") + "\n---\n".length).trimEnd();
      if (!SKIPPED[name]) found.push({ name, script, files, write: !NOT_WRITING.includes(stem), expected });
    }
  }
  return found;
}

/** In the page: runs a transcript in the page's worker. */
async function transcriptIn({ script, files, write }) {
  globalThis.asked ??= await (async () => {
    const worker = new Worker("worker.js"), waiting = [];
    worker.onmessage = ({ data }) => !data.event && waiting.shift()(data);
    const ask = (what, value) => new Promise((done) => { waiting.push(done); worker.postMessage({ id: 0, what, value }); });
    await ask("load", new URL("gapilib.wasm.gz", location.href).href);
    return ask;
  })();
  const decoded = Object.entries(files).map(([path, text]) => [path, Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))]);
  const { answer, failed } = await globalThis.asked("plain", { script, files: Object.fromEntries(decoded), write });
  return failed ?? `${answer.transcript}[exit code ${answer.exit_code}]`;
}

const text = (page, id) => page.$eval("#" + id, (element) => (element.id === "text" ? [...element.children].map((line) => line.textContent.trimEnd()).join("\n") : element.textContent));
const wait = (time) => new Promise((done) => setTimeout(done, time));
const click = (page, id) => page.$eval("#" + id, (element) => element.click());
const ended = (page, timeout = 120000) => page.waitForFunction(() => /^Done|^The script ended|^The run failed|^Stopped/.test(document.getElementById("status").textContent), { timeout });
const report = (name, text) => console.log(`${name}: ${text}`);

for (const { name, path, options } of BROWSERS) {
  describe(name, { skip: path ? false : `${name} is not here` }, () => {
    let browser, darkBrowser, server, at;
    before(async () => {
      browser = await puppeteer.launch({ executablePath: path, headless: true, protocolTimeout: 600000, ...options });
      // Firefox has no emulation of a preference: another instance prefers dark pages.
      const dark = { extraPrefsFirefox: { "layout.css.prefers-color-scheme.content-override": 0, "ui.systemUsesDarkTheme": 1 } };
      darkBrowser = name === "firefox" ? await puppeteer.launch({ executablePath: path, headless: true, protocolTimeout: 600000, ...options, ...dark }) : browser;
      server = await serve(join(web, "play"));
      at = `http://localhost:${server.address().port}/index.html`;
    });
    after(async () => { await browser?.close(); if (darkBrowser !== browser) await darkBrowser?.close(); server?.close(); });

    /** The page when it is ready; what goes wrong in it fails the test. */
    async function opened(url = at, { width = 1280, height = 800, dark = false } = {}) {
      const page = await (dark ? darkBrowser : browser).newPage();
      page.wrong = [];
      page.on("pageerror", (error) => page.wrong.push(error.message));
      await page.setViewport({ width, height });
      if (dark && name === "chromium") await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
      await page.goto(url);
      await page.evaluate(() => { try { localStorage.clear(); sessionStorage.clear(); } catch { /* none */ } });
      await page.goto("about:blank");
      await page.goto(url);
      await page.waitForSelector("body[data-ready]", { timeout: 60000 });
      return page;
    }
    async function closed(page) {
      assert.deepEqual(page.wrong, []);
      await page.close();
    }
    const open = (page, value) => page.$eval("#open", (select, value) => { select.value = value; select.dispatchEvent(new Event("change")); }, value);

    test("first paint below 1 s, download below 4 MB", async () => {
      const page = await opened();
      const paint = await page.evaluate(() => performance.getEntriesByType("paint").find(({ name }) => name === "first-contentful-paint")?.startTime);
      const loaded = await page.evaluate(() => performance.getEntriesByType("resource").map(({ name }) => name));
      // The page and its script as a server sends them compressed; the module is compressed itself.
      const sizes = ["index.html", "play.js", "worker.js"].map((file) => gzipSync(readFileSync(join(web, "play", file)), { level: 9 }).length);
      const bytes = sizes.reduce((sum, size) => sum + size, readFileSync(join(web, "play/gapilib.wasm.gz")).length);
      report(name, `first contentful paint ${paint?.toFixed(0)} ms, download ${bytes} bytes`);
      assert.ok(paint < 1000, `${paint}`);
      assert.ok(loaded.every((name) => /\/(play\.js|worker\.js|gapilib\.wasm\.gz|favicon\.ico)$/.test(name)), loaded.join());
      if (!process.env.GAPILIB_WEB_FOLDER) assert.ok(bytes < 4e6, `${bytes}`);
      await closed(page);
    });

    test("the transcripts have the same bytes", async () => {
      const page = await opened();
      const wrong = [];
      const all = transcripts();
      for (const one of all) {
        const said = (await page.evaluate(transcriptIn, one)).trimEnd();
        if (said !== one.expected) wrong.push(one.name);
      }
      report(name, `${all.length - wrong.length} of ${all.length} transcripts the same, ${Object.keys(SKIPPED).length} left out`);
      assert.deepEqual(wrong, []);
      assert.ok(all.length > 150);
      await closed(page);
    });

    test("the four scripts run, and their steps can be walked through", async () => {
      const page = await opened();
      await page.screenshot({ path: join(pictures, `${name}-edit.png`) });
      await click(page, "run");
      await ended(page);
      assert.match(await text(page, "text"), /Identified parameters of Tank[^]*800 in 40 generations, 280 failed/);
      const generation = async () => Number(/generation (\d+) of 40/.exec(await text(page, "headline"))[1]);
      const last = await generation();
      assert.equal(last, 40);
      await page.screenshot({ path: join(pictures, `${name}-live.png`) });
      await click(page, "before");
      assert.equal(await generation(), last - 1);
      await click(page, "tab-steps");
      const frame = await (await page.waitForSelector("#steps iframe")).contentFrame();
      await frame.waitForSelector("#title");
      const times = await frame.evaluate(() => [...Array(40)].map(() => {
        const before = performance.now();
        document.getElementById("next").click();
        document.body.getBoundingClientRect();
        return performance.now() - before;
      }).sort((a, b) => a - b));
      report(name, `step: median ${times[20].toFixed(1)} ms, largest ${times[39].toFixed(1)} ms`);
      assert.ok(times[20] < 50);
      await page.screenshot({ path: join(pictures, `${name}-steps.png`) });
      // What if: the page within asks, both runs come beside each other.
      await frame.evaluate(() => { document.getElementById("changed-to").value = "0.9"; document.getElementById("run-what-if").click(); });
      await page.waitForFunction(() => /^Compared/.test(document.getElementById("status").textContent), { timeout: 60000 });
      const second = await (await page.waitForSelector("#steps iframe")).contentFrame();
      await second.waitForSelector("#last");
      await second.evaluate(() => document.getElementById("last").click());
      assert.match(await second.$eval("#both", (element) => element.textContent), /F_Mut := 0.9/);
      await second.$eval("#what-if-panel", (element) => element.scrollIntoView());
      await page.screenshot({ path: join(pictures, `${name}-what-if.png`) });
      await closed(page);
    });

    test("a run is stopped, and changed while it goes on", async () => {
      const page = await opened();
      await open(page, "example 2");
      await click(page, "run");
      await page.waitForFunction(() => /generation [1-9]\d+ of/.test(document.getElementById("headline").textContent), { timeout: 60000 });
      const suspends = await page.evaluate(() => typeof WebAssembly.Suspending === "function");
      report(name, `can suspend a run: ${suspends}`);
      await page.$eval("#statement", (input) => { input.value = "F_Mut := 0.5"; });
      await page.$eval("#change button", (button) => button.click());
      await page.waitForFunction(() => /F_Mut := 0.5 from generation \d+/.test(document.getElementById("change-said").textContent), { timeout: 60000, polling: 5 });
      await wait(1000);
      await click(page, "stop");
      await ended(page);
      assert.match(await text(page, "status"), /^Stopped in generation \d+/);
      assert.match(await text(page, "text"), /Identified parameters of CaseStudies.PolarizationCurve[^]*stopped/);
      // A hundred individuals are folded.
      const frame = await (await page.waitForSelector("#steps iframe")).contentFrame();
      await frame.waitForSelector("#population .row");
      const rows = () => frame.$$eval("#population .row", (rows) => rows.length);
      assert.ok(await rows() <= 30, `${await rows()}`);
      await frame.evaluate(() => document.getElementById("unfold").click());
      assert.equal(await rows(), 100);
      await closed(page);
    });

    /** In the page of the steps: labels that overlap, and heads that are neither a gene's name nor its number. */
    function unreadable() {
      const found = [], { parameters } = JSON.parse(document.getElementById("data").textContent);
      for (const image of document.querySelectorAll("#drawing svg, #population svg")) {
        const texts = [...image.querySelectorAll("text")].map((one) => [one.textContent.trim(), one.getBoundingClientRect()]).filter(([text]) => text);
        texts.forEach(([text, a], k) => texts.slice(k + 1).forEach(([other, b]) => {
          const [across, down] = [Math.min(a.right, b.right) - Math.max(a.left, b.left), Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top)];
          // The height of a text has room above and below its letters.
          if (across > 1 && down > 0.25 * Math.min(a.height, b.height)) found.push(`"${text}" and "${other}" overlap`);
        }));
      }
      for (const head of document.querySelectorAll("#population text[y='30']")) {
        if (!/^\d+$/.test(head.textContent) && !parameters.includes(head.textContent)) found.push(`"${head.textContent}" is cut`);
      }
      return found;
    }

    test("the steps within the page: sentence, drawing and population are in view", async () => {
      for (const [width, height] of [[1280, 800], [390, 844]]) {
        const page = await opened(at, { width, height });
        await click(page, "run");
        await ended(page);
        await click(page, "tab-steps");
        const frame = await (await page.waitForSelector("#steps iframe")).contentFrame();
        await frame.waitForSelector("#population .row");
        await wait(500);
        const wrong = await frame.evaluate((check) => {
          const { steps } = JSON.parse(document.getElementById("data").textContent), found = [];
          const end = innerHeight - 56, bottom = (element) => element.getBoundingClientRect().bottom;
          const unreadable = eval(`(${check})`);
          for (const title of new Set(steps.map(({ title }) => title))) {
            const { g } = steps.find((step) => step.title === title);
            const go = (id, value) => { const input = document.getElementById(id); input.value = value; input.dispatchEvent(new Event("input")); };
            go("generations", g + 1);
            go("slider", steps.findIndex((step) => step.title === title) - steps.findIndex((step) => step.g === g) + 1);
            scrollTo(0, 0);
            const drawing = document.querySelector("#drawing svg"), rows = [...document.querySelectorAll("#population .row")].filter((row) => bottom(row) <= end).length;
            if (!drawing || bottom(drawing) > end) found.push(`${title}: the drawing ends at ${drawing && bottom(drawing)} of ${end}`);
            if (rows < 3) found.push(`${title}: ${rows} rows in view`);
            found.push(...unreadable().map((text) => `${title}: ${text}`));
            for (const text of drawing?.querySelectorAll("text") ?? []) {
              const { x, width } = text.getBBox();
              if (x < -1 || x + width > drawing.viewBox.baseVal.width + 1) found.push(`${title}: "${text.textContent}" is cut off`);
            }
          }
          return found;
        }, String(unreadable));
        await page.screenshot({ path: join(pictures, `${name}-${width}-steps-within.png`) });
        assert.deepEqual(wrong, [], `${width}`);
        await closed(page);
      }
    });

    /** Types a change into a run, and waits for what becomes of it. */
    async function changed(page, statement) {
      await page.waitForFunction(() => !document.getElementById("change").hidden, { timeout: 60000 });
      await page.evaluate((statement) => {
        document.getElementById("change-said").textContent = "";
        document.getElementById("statement").value = statement;
        document.querySelector("#change button").click();
      }, statement);
      await page.waitForFunction(() => document.getElementById("change-said").textContent, { timeout: 120000, polling: 20 });
      return text(page, "change-said");
    }
    for (const path of ["", "plain/"]) {
      test(`a change is checked before it is made${path && ", also where the engine cannot suspend a run"}`, async () => {
        const page = await opened(at.replace("index.html", path + "index.html"));
        // Long enough to be changed several times.
        await page.evaluate(() => document.querySelector("#files [role=tab]").click());
        await open(page, "example 2");
        await click(page, "run");
        await page.waitForFunction(() => /generation [1-9]\d* of/.test(document.getElementById("headline").textContent), { timeout: 60000 });
        for (const [statement, says] of [["garbage (", /^Not changed/], ["F_mut := 0.5", /^Not changed.*did you mean `F_Mut`/], ["F_Mut := 0,5", /^Not changed.*with a point/], ["F_Mut := 7", /^Not changed.*F_Mut is 7/], ["F_Mut := 0.5", /^F_Mut := 0.5 from generation \d+ on/]]) {
          assert.match(await changed(page, statement), says, statement);
          assert.equal(await page.$eval("#stop", (button) => button.disabled), false, `${statement}: the run continues`);
        }
        await click(page, "stop");
        await ended(page);
        // Without suspension it is computed again up to where it was stopped.
        await page.waitForFunction(() => /^Stopped in generation/.test(document.getElementById("status").textContent), { timeout: 120000 });
        assert.match(await text(page, "text"), /Identified parameters of CaseStudies.PolarizationCurve[^]*stopped/);
        await closed(page);
      });
    }

    test("a changed run that fails is not shown as a result", async () => {
      const page = await opened();
      await click(page, "run");
      await ended(page);
      await click(page, "tab-steps");
      for (const value of ["7", "-1", "abc", "(" ]) {
        const frame = await (await page.waitForSelector("#steps iframe")).contentFrame();
        await frame.waitForSelector("#title");
        await page.$eval("#status", (status) => { status.textContent = ""; });
        await frame.evaluate((value) => { document.getElementById("changed-to").value = value; document.getElementById("run-what-if").click(); }, value);
        await page.waitForFunction(() => /^(No comparison|Compared)/.test(document.getElementById("status").textContent), { timeout: 60000 });
        assert.match(await text(page, "status"), /^No comparison: ./, value);
        await frame.waitForFunction(() => /^No comparison: ./.test(document.getElementById("what-if-said").textContent));
        assert.equal(await frame.$eval("#both", (element) => element.hidden), true, value);
        assert.equal(await frame.$eval("#changed-to", (input) => input.value), value);
      }
      // After a comparison it stays, with what was entered for it, whatever is entered then.
      const asked = async (value) => {
        const frame = await stepsOf(page);
        await page.$eval("#status", (status) => { status.textContent = ""; });
        await frame.evaluate((value) => { document.getElementById("changed-to").value = value; document.getElementById("run-what-if").click(); }, value);
      };
      await asked("0.9");
      await page.waitForFunction(() => /^Compared/.test(document.getElementById("status").textContent), { timeout: 60000 });
      await wait(500);
      const frame = await stepsOf(page), shown = (id) => frame.$eval("#" + id, (element) => element.value ?? element.textContent);
      assert.equal(await shown("changed-to"), "0.9");
      const both = await shown("both");
      assert.match(both, /F_Mut := 0.9/);
      for (const [value, says] of [["7", /^No comparison: .*F_Mut is 7.*[^.]\. Below is the comparison before, with F_Mut := 0.9/], ["", /^Enter a value for F_Mut/]]) {
        await asked(value);
        await frame.waitForFunction((says) => new RegExp(says).test(document.getElementById("what-if-said").textContent), { timeout: 60000 }, says.source);
        assert.equal(await shown("changed-to"), value);
        assert.equal(await shown("both"), both);
      }
      await closed(page);
    });

    test("every statement that is entered while a run is paused has its verdict", async () => {
      const page = await opened();
      await open(page, "example 2");
      await click(page, "run");
      await page.waitForFunction(() => /generation [1-9]\d* of/.test(document.getElementById("headline").textContent), { timeout: 60000 });
      if (!await page.evaluate(() => typeof WebAssembly.Suspending === "function")) {
        assert.equal(await page.$eval("#pause", (button) => button.disabled), true);
        return closed(page);
      }
      await click(page, "pause");
      await page.waitForFunction(() => /^Paused/.test(document.getElementById("status").textContent), { timeout: 60000 });
      const statements = ["F_Mut := 0.5", "F_mut := 0.5", "N_Elitism := 2"];
      for (const statement of statements) {
        await page.$eval("#statement", (input, statement) => { input.value = statement; }, statement);
        await page.$eval("#change button", (button) => button.click());
      }
      const lines = () => page.$$eval("#change-said p", (lines) => lines.map((line) => line.className + ": " + line.textContent).reverse());
      assert.deepEqual(await lines(), statements.map((statement) => `waiting: ${statement} is checked when the run resumes.`));
      await click(page, "pause");
      await page.waitForFunction(() => !document.querySelector("#change-said .waiting"), { timeout: 60000 });
      const [first, second, third, ...more] = await lines();
      assert.match(first, /^done: F_Mut := 0.5 from generation \d+ on/);
      assert.match(second, /^refused: Not changed by F_mut := 0.5: .*did you mean `F_Mut`/);
      assert.match(third, /^done: N_Elitism := 2 from generation \d+ on/);
      assert.deepEqual(more, []);
      assert.ok(await page.$eval("#change-said", (list) => list.scrollHeight <= list.clientHeight + 1), "none is out of sight");
      assert.equal(await page.$eval("#statement", (input) => input.value), "F_mut := 0.5", "what was refused can be put right");
      await click(page, "stop");
      await ended(page);
      await closed(page);
    });

    /** The page of the steps when it is there. */
    async function stepsOf(page) {
      const frame = await (await page.waitForSelector("#steps iframe")).contentFrame();
      await frame.waitForSelector("#title");
      return frame;
    }
    /** Runs a lesson with its solution in it, and opens its steps. */
    async function stepsOfLesson(page, number) {
      await open(page, "lesson " + number);
      const { solution } = await page.evaluate(() => {
        document.getElementById("solution").click();
        return { solution: [...document.querySelectorAll("#lesson-said pre")].map((pre) => pre.textContent) };
      });
      const work = await page.evaluate(() => JSON.parse(localStorage.getItem("gapilib-work")));
      for (let k = 0; k < solution.length; k += 2) work.files[work.main] = work.files[work.main].replace(solution[k], solution[k + 1]);
      const { packed } = await import("./src/share.js");
      const link = await packed(work);
      await page.evaluate((link) => { location.hash = "p=" + link; }, link);
      await page.waitForFunction((text) => JSON.parse(localStorage.getItem("gapilib-work")).files[JSON.parse(localStorage.getItem("gapilib-work")).main] === text, {}, work.files[work.main]);
      await click(page, "run");
      await ended(page);
      await click(page, "tab-steps");
      const frame = await stepsOf(page);
      await wait(300);
      return frame;
    }
    const titleOf = (frame) => frame.$eval("#title", (element) => element.textContent);

    test("the steps of lessons say what there is, and nothing else", async () => {
      const page = await opened();
      // Lesson 1 compares by itself.
      let frame = await stepsOfLesson(page, 1);
      assert.match(await frame.$eval("#fit", (element) => element.textContent), /No call of Fit compares this simulation/);
      await frame.evaluate(() => document.getElementById("last").click());
      assert.doesNotMatch(await frame.$eval("#population", (element) => element.textContent), /NaN|children|best first/);
      for (const id of ["landscape", "family", "what-if"]) assert.equal(await frame.$eval(`#${id}-panel`, (panel) => panel.hidden), true, id);
      // Lesson 2 has no children.
      frame = await stepsOfLesson(page, 2);
      await frame.evaluate(() => document.getElementById("last").click());
      assert.match(await titleOf(frame), /Evaluation 1 of 1: stop/);
      assert.doesNotMatch(await frame.$eval("#population", (element) => element.textContent), /children/);
      // Lesson 3 draws in ranges, and its searches are no generations.
      frame = await stepsOfLesson(page, 3);
      assert.match(await text(page, "headline"), /evaluation 4 of 4/);
      assert.match(await text(page, "curve-title"), /evaluations/);
      assert.match(await titleOf(frame), /Evaluation 1 of 4: sampling/);
      const drawing = await frame.$$eval("#drawing text", (all) => all.map((one) => one.textContent));
      for (const end of ["5", "20", "1", "10"]) assert.ok(drawing.includes(end), `${end} in ${drawing}`);
      assert.match(await frame.$eval("#text", (element) => element.textContent), /returned 2 random numbers between 0 and 1\. Each number u sets one gene: V0 from 5\.000 \(u = 0\) to 20\.00 \(u = 1\), tau from 1\.000/);
      // Lesson 6: what mutates and what stays have their colours.
      frame = await stepsOfLesson(page, 6);
      const colours = () => frame.$$eval("#drawing circle", (all) => all.map((one) => one.getAttribute("class") + " " + one.getAttribute("fill")).filter((one) => /^hit|^missed/.test(one)));
      const cells = () => frame.$$eval("#population .row rect[fill^=var]", (all) => all.map((one) => one.getAttribute("fill")));
      assert.deepEqual(await colours(), Array(4).fill("missed var(--blue)"));
      assert.ok((await cells()).length > 32 && (await cells()).every((fill) => fill === "var(--first)"));
      await frame.evaluate(() => document.getElementById("last").click());
      assert.deepEqual(await colours(), Array(4).fill("hit var(--orange)"));
      assert.equal(await frame.$$eval("#population .changed", (all) => all.length), 32);
      assert.equal((await cells()).filter((fill) => fill === "var(--second)").length, 32);
      await closed(page);
    });

    test("a run says what its numbers are for, and why simulations fail", async () => {
      const page = await opened();
      await click(page, "run");
      await ended(page);
      assert.match(await text(page, "failures"), /Why they failed: `sqrt` has no value: the argument must not be negative\. .*landscape/);
      assert.equal(await page.$eval("#failures", (element) => element.hidden), false);
      await click(page, "tab-steps");
      const frame = await stepsOf(page);
      assert.match(await frame.$eval("#text", (element) => element.textContent), /returned 41 random numbers between 0 and 1\. The first one gives the crossing point \(Cross_Point = 1\)\. Each of the other 40 numbers u sets one gene within its range/);
      // The number of the generation: what is none is said, and nothing moves.
      const title = await titleOf(frame);
      for (const entry of ["", "9999", "0", "2.5"]) {
        await frame.evaluate((entry) => { const box = document.getElementById("generation"); box.value = entry; box.dispatchEvent(new Event("change")); }, entry);
        assert.deepEqual([await frame.$eval("#jump", (element) => element.textContent), await titleOf(frame)], ["Enter a number from 1 to 40.", title], entry);
      }
      await (await frame.$("#generation")).focus();
      await page.keyboard.type("abc");
      await page.keyboard.press("Enter");
      assert.equal(await titleOf(frame), title);
      // Predictions: two genes are not asked where they were cut, and an answer belongs to its question.
      const questions = await frame.evaluate(() => JSON.parse(document.getElementById("data").textContent).steps.map(({ question }) => question).filter(Boolean));
      assert.ok(questions.length > 100 && questions.every(({ answer }) => !("Number" in answer) || answer.Number.of > 1), JSON.stringify(questions.slice(0, 5)));
      assert.ok(questions.some(({ text }) => text.startsWith("Parent a, rank 3")));
      await frame.evaluate(() => { document.getElementById("predicting").click(); });
      while (await frame.$eval("#prediction", (form) => form.hidden)) await frame.evaluate(() => document.getElementById("next").click());
      await frame.evaluate(() => { document.getElementById("answer").value = "1 2"; document.getElementById("next").click(); });
      assert.equal(await frame.$eval("#answer", (input) => input.value), "");
      await closed(page);
    });

    test("what is wrong with a problem file leads to its place", async () => {
      const page = await opened();
      const problem = (data, column) => `model = "Decay"\nfiles = ["Decay.mo"]\n[parameters]\ntau = { min = 1, max = 9 }\n[[experiment]]\ndata = "${data}"\nx = { variable = "time", column = "t" }\noutputs = { v = "${column}" }\n`;
      const files = { "Decay.mo": "model Decay\n  parameter Real tau = 1;\n  output Real v;\nequation\n  v = 10*exp(-time/tau);\nend Decay;\n", "decay.csv": "t,v\n0,10\n2,6\n" };
      const { packed } = await import("./src/share.js");
      const cases = [["decay.csv", "volt", "p.toml", 'outputs = { v = "volt" }'], ["decoy.csv", "v", "p.toml", 'data = "decoy.csv"'], ["decay.csv", "v", "q.toml", 'identify("q.toml");']];
      for (const [data, column, named, line] of cases) {
        const script = `identify("${named}");`;
        const link = await packed({ files: { ...files, "p.toml": problem(data, column), "own.mos": script }, main: "own.mos" });
        await page.evaluate((link) => { location.hash = "p=" + link; }, link);
        await page.waitForFunction((script) => JSON.parse(localStorage.getItem("gapilib-work")).files["own.mos"] === script, {}, script);
        await wait(100);
        await click(page, "run");
        await ended(page);
        await page.$eval("#text a", (link) => link.click());
        assert.equal(await page.$eval(".cm-activeLine", (element) => element.textContent), line);
      }
      await closed(page);
    });

    test("on a phone a lesson says its task and its verdict without scrolling", async () => {
      const page = await opened(at, { width: 390, height: 844 });
      const inView = (id) => page.$eval("#" + id, (element) => {
        const { top, bottom, height } = element.getBoundingClientRect(), edit = document.getElementById("edit").getBoundingClientRect();
        const cut = [];
        for (let one = element; one.id !== "edit"; one = one.parentElement) if (one.scrollHeight > one.clientHeight + 1 && getComputedStyle(one).overflowY !== "visible") cut.push(one.id);
        return height > 10 && top >= edit.top - 1 && bottom <= edit.bottom + 1 && cut.length === 0;
      });
      for (let number = 1; number <= 6; number++) {
        await open(page, "lesson " + number);
        await wait(200);
        assert.match(await text(page, "lesson-do"), /^Your task: /);
        assert.ok(await inView("lesson-do"), `the task of lesson ${number}`);
        // What is folded says that there is more, and shows it.
        const [isFolded, hasMore] = await page.evaluate(() => { const about = document.getElementById("lesson-about"); return [about.scrollHeight > about.clientHeight + 1, !document.getElementById("lesson-more").hidden]; });
        assert.equal(isFolded, hasMore, `lesson ${number}`);
        if (hasMore) {
          await page.click("#lesson-more");
          assert.ok(await page.$eval("#lesson-about", (about) => about.scrollHeight <= about.clientHeight + 1));
        }
      }
      await stepsOfLesson(page, 4);
      await click(page, "to-edit");
      await page.click("#check");
      await page.waitForFunction(() => /is passed/.test(document.getElementById("lesson-said").textContent), { timeout: 60000 });
      assert.match(await text(page, "lesson-said"), /Watch the selection/);
      assert.ok(await inView("lesson-said"), "what is said of lesson 4");
      assert.ok(await inView("next-lesson"), "the way on");
      await page.screenshot({ path: join(pictures, `${name}-phone-lesson-4-passed.png`) });
      // The names of the genes are whole or numbers, and no texts overlap.
      for (const number of [5, 6]) {
        const frame = await stepsOfLesson(page, number);
        for (const end of ["first", "last"]) {
          await frame.evaluate((end) => document.getElementById(end).click(), end);
          const wrong = await frame.evaluate(unreadable);
          assert.deepEqual(wrong, [], `lesson ${number}, ${end}`);
        }
      }
      await closed(page);
    });

    const files = (page) => page.evaluate(() => JSON.parse(localStorage.getItem("gapilib-work")).files);
    const listed = (page) => page.$$eval("#open optgroup[label='Your work'] option", (options) => options.map(({ value }) => value));
    /** Drops files, given by their bytes, on the page. */
    const drop = (page, name, bytes) => page.evaluate((name, bytes) => {
      const data = new DataTransfer();
      data.items.add(new File([new Uint8Array(bytes)], name, { type: "text/csv" }));
      dispatchEvent(new DragEvent("drop", { dataTransfer: data }));
    }, name, [...bytes]);
    const write = async (page, line) => {
      await page.click(".cm-content");
      await page.keyboard.down("Control");
      await page.keyboard.press("Home");
      await page.keyboard.up("Control");
      await page.keyboard.type(line + "\n");
    };

    test("what the user has written is kept when something else is opened", async () => {
      const page = await opened();
      await write(page, "// my own line");
      await drop(page, "mine.csv", Buffer.from("t,y\n1,2\n"));
      await page.waitForFunction(() => /mine.csv/.test(document.getElementById("said").textContent));
      const own = await files(page);
      await open(page, "example 1");
      assert.ok(!("mine.csv" in await files(page)));
      await page.click("#undo");
      assert.deepEqual(await files(page), own);
      assert.deepEqual(await listed(page), []);
      // A lesson, and a link, do not lose it either.
      await open(page, "lesson 1");
      const { packed } = await import("./src/share.js");
      const link = await packed({ files: { "theirs.mos": "print(1)" }, main: "theirs.mos" });
      await page.evaluate((link) => { location.hash = "p=" + link; }, link);
      await page.waitForFunction(() => JSON.parse(localStorage.getItem("gapilib-work")).main === "theirs.mos");
      const [mine, ...others] = await listed(page);
      assert.deepEqual(others, [], "what has not been changed is not kept");
      await page.reload();
      await page.waitForSelector("body[data-ready]", { timeout: 60000 });
      await open(page, mine);
      assert.deepEqual(await files(page), own);
      // What was opened and not changed goes without a word.
      await open(page, "example 0");
      await open(page, "example 1");
      assert.equal((await listed(page)).length, 1);
      await closed(page);
    });

    test("two windows keep what was written in each", async () => {
      const first = await opened();
      const second = await browser.newPage();
      await second.goto(at);
      await second.waitForSelector("body[data-ready]", { timeout: 60000 });
      await write(second, "// of the second");
      await first.bringToFront();
      await write(first, "// of the first");
      await second.bringToFront();
      await second.reload();
      await second.waitForSelector("body[data-ready]", { timeout: 60000 });
      const texts = Object.values(await second.evaluate(() => JSON.parse(sessionStorage.getItem("gapilib-work")).files));
      assert.ok(texts.some((text) => text.includes("// of the second")));
      assert.equal((await listed(first)).length + (await listed(second)).length > 0, true, "the other's work is on the list");
      await second.close();
      await closed(first);
    });

    test("keys go on from what is open, and the focus stays", async () => {
      const page = await opened();
      await page.focus("#open");
      assert.equal(await page.$eval("#open", (select) => select.value), "example 0");
      await page.keyboard.press("ArrowDown");
      await page.waitForFunction(() => document.getElementById("open").value === "example 1");
      await page.focus("#open");
      await page.keyboard.press("ArrowDown");
      await page.waitForFunction(() => document.getElementById("open").value === "example 2");
      await open(page, "lesson 1");
      await page.focus("#check");
      await page.keyboard.press("Enter");
      await page.waitForFunction(() => /Lesson 1 is/.test(document.getElementById("lesson-said").textContent), { timeout: 60000 });
      await page.waitForFunction(() => document.activeElement.id === "check");
      await page.focus("#run");
      await page.keyboard.press("Enter");
      await page.waitForFunction(() => /Done|error/.test(document.getElementById("status").textContent), { timeout: 60000 });
      await page.waitForFunction(() => document.activeElement.id === "run");
      assert.equal(await page.$eval("#output", (panel) => panel.hidden), false, "a script without generations shows what it prints");
      await closed(page);
    });

    test("a file that is not needed is removed, and comes back with Undo", async () => {
      const page = await opened();
      await drop(page, "not_needed.csv", Buffer.from("# from the lab\nt;y\ns;mV\n1;2,5\n2;3\n"));
      await page.waitForFunction(() => /2 rows/.test(document.getElementById("said").textContent));
      await page.click("#remove");
      assert.ok(!("not_needed.csv" in await files(page)));
      await page.click("#undo");
      assert.ok("not_needed.csv" in await files(page));
      await closed(page);
    });

    test("a lesson that is started again comes back with Undo", async () => {
      const page = await opened();
      await open(page, "lesson 2");
      await write(page, "// my solution");
      const own = await files(page);
      await page.click("#reset");
      assert.notDeepEqual(await files(page), own);
      await page.click("#undo");
      assert.deepEqual(await files(page), own);
      // A link to the lesson does not replace it either.
      const { packed } = await import("./src/share.js");
      const link = await packed({ files: { "02_fitness_is_a_sum.mos": "x = 1;" }, main: "02_fitness_is_a_sum.mos", lesson: 2 });
      await open(page, "example 1");
      await page.evaluate((link) => { location.hash = "p=" + link; }, link);
      await page.waitForFunction(() => JSON.parse(localStorage.getItem("gapilib-work")).lesson === 2);
      await open(page, (await listed(page))[0]);
      assert.deepEqual(await files(page), own);
      await closed(page);
    });

    test("tables are read as spreadsheets write them", async () => {
      const page = await opened();
      // Latin-1: the degree sign is one byte.
      await drop(page, "oven.csv", Buffer.from("t [s];T [\xb0C]\n0;20\n10;30\n", "latin1"));
      await page.waitForFunction(() => /oven.csv/.test(document.getElementById("said").textContent));
      assert.match(await text(page, "said"), /2 rows with the columns "t \[s\]", "T \[\u00b0C\]"\. Name it in GAPILib_INI\.mos, in the line with Exp_Adq_SISO/);
      assert.equal((await files(page))["oven.csv"], "t [s];T [\u00b0C]\n0;20\n10;30\n");
      await drop(page, "empty.csv", Buffer.from("\n"));
      await page.waitForFunction(() => /^Warning: empty.csv is empty/.test(document.getElementById("said").textContent));
      // A wrong cell leads to its place.
      const script = '(s, n, X, Y) := Exp_Adq_SISO("bad.csv", "a", "b");';
      const { packed } = await import("./src/share.js");
      const link = await packed({ files: { "bad.mos": script, "bad.csv": "a;b\n1;2\n3;x\n" }, main: "bad.mos" });
      await page.evaluate((link) => { location.hash = "p=" + link; }, link);
      await page.waitForFunction(() => JSON.parse(localStorage.getItem("gapilib-work")).main === "bad.mos");
      await click(page, "run");
      await ended(page);
      await page.$eval("#text a", (link) => link.click());
      assert.equal(await page.$eval(".cm-activeLine", (element) => element.textContent), "3;x");
      await closed(page);
    });

    test("an error of a lesson leads to its place", async () => {
      const page = await opened();
      await open(page, "lesson 4");
      await write(page, "q = missing + 1;");
      await page.click("#check");
      await page.waitForSelector("#lesson-said a");
      await page.$eval("#lesson-said a", (link) => link.click());
      assert.equal(await page.$eval(".cm-activeLine", (element) => element.textContent), "q = missing + 1;");
      await closed(page);
    });

    test("lessons on a phone: the line to change is in view", async () => {
      const page = await opened(at, { width: 390, height: 844 });
      for (let number = 1; number <= 6; number++) {
        await open(page, "lesson " + number);
        await wait(300);
        const marked = await page.evaluate(() => [...document.querySelectorAll(".cm-line")].filter((line) => /<-|^Guess := /.test(line.textContent)).some((line) => {
          const { top, bottom } = line.getBoundingClientRect(), editor = document.getElementById("editor").getBoundingClientRect();
          return top >= editor.top && bottom <= Math.min(editor.bottom, innerHeight);
        }));
        await page.screenshot({ path: join(pictures, `${name}-phone-lesson-${number}.png`) });
        assert.ok(marked, `lesson ${number}`);
      }
      await closed(page);
    });

    test("case 4.1 with the settings of the paper below 15 s", { skip: process.env.GAPILIB_WEB_FOLDER ? "not optimized" : false }, async () => {
      const page = await opened();
      await open(page, "example 2");
      const start = performance.now();
      await click(page, "run");
      await ended(page);
      const seconds = (performance.now() - start) / 1000;
      report(name, `case 4.1: ${seconds.toFixed(1)} s; ${await text(page, "status")}`);
      const table = readFileSync(join(project, "README.md"), "utf8").split("\n").filter((line) => /^  (A|In|Io|B|R|Ilim) +\d/.test(line));
      const output = await text(page, "text");
      assert.equal(table.length, 6);
      for (const row of table) assert.ok(output.includes(row.trimEnd()), row);
      assert.ok(seconds < 15, `${seconds}`);
      await closed(page);
    });

    test("an error leads to its place", async () => {
      const page = await opened();
      await page.click(".cm-content");
      await page.keyboard.down("Control");
      await page.keyboard.press("Home");
      await page.keyboard.up("Control");
      await page.keyboard.type("q = missing + 1\n");
      await click(page, "run");
      await ended(page);
      assert.match(await text(page, "text"), /error\[.*missing/);
      await page.screenshot({ path: join(pictures, `${name}-error.png`) });
      await page.$eval("#text a", (link) => link.click());
      const line = await page.$eval(".cm-activeLine", (element) => element.textContent);
      assert.equal(line, "q = missing + 1");
      await closed(page);
    });

    test("the keyboard is enough", async () => {
      const page = await opened();
      await page.focus("#tab-live");
      await page.keyboard.press("ArrowRight");
      assert.equal(await page.$eval("#tab-steps", (tab) => tab.getAttribute("aria-selected")), "true");
      await page.focus("#files [aria-selected=true]");
      const shown = () => page.$eval("#files [aria-selected=true]", (tab) => tab.textContent);
      assert.equal(await shown(), "GAPILib_INI.mos");
      await page.keyboard.press("ArrowRight");
      assert.equal(await shown(), "GAPILib_CYCLE.mos");
      assert.ok(await page.$eval("#files [aria-selected=true]", (tab) => tab === document.activeElement));
      await page.focus(".cm-content");
      await page.keyboard.press("Escape");
      await page.keyboard.press("Tab");
      assert.ok(await page.evaluate(() => !document.activeElement.closest("#editor")));
      await page.keyboard.down("Control");
      await page.keyboard.press("Enter");
      await page.keyboard.up("Control");
      await ended(page);
      assert.match(await text(page, "status"), /^Done/);
      await closed(page);
    });

    test("a lesson is failed, hinted at, solved and remembered", async () => {
      const page = await opened();
      await open(page, "lesson 1");
      await page.click("#check");
      await page.waitForFunction(() => /not passed yet/.test(document.getElementById("lesson-said").textContent));
      await page.click("#hint");
      assert.match(await text(page, "lesson-said"), /Hint 1 of/);
      await page.screenshot({ path: join(pictures, `${name}-lesson.png`) });
      const [solution] = await page.evaluate(() => { document.getElementById("solution").click(); return [[...document.querySelectorAll("#lesson-said pre")].map((pre) => pre.textContent)]; });
      const script = await page.evaluate(() => JSON.parse(localStorage.getItem("gapilib-work")));
      let solved = script.files[script.main];
      for (let k = 0; k < solution.length; k += 2) solved = solved.replace(solution[k], solution[k + 1]);
      const { packed } = await import("./src/share.js");
      const link = await packed({ ...script, files: { ...script.files, [script.main]: solved } });
      await page.evaluate((link) => { location.hash = "p=" + link; }, link);
      await wait(500);
      await page.click("#check");
      await page.waitForFunction(() => /is passed/.test(document.getElementById("lesson-said").textContent));
      assert.match(await page.$eval("#open", (select) => select.textContent), /\u2713 1\./);
      await closed(page);
    });

    test("files are dropped, shared as a link, and downloaded for the command line", async () => {
      const page = await opened();
      await page.evaluate(() => {
        const data = new DataTransfer();
        data.items.add(new File(["t,level\n0,1.4\n2,1.2\n4,1.0\n6,0.8\n"], "levels.csv", { type: "text/csv" }));
        dispatchEvent(new DragEvent("drop", { dataTransfer: data }));
      });
      await page.waitForFunction(() => /^levels.csv: 4 rows.*It replaces the file of this name/.test(document.getElementById("said").textContent));
      await click(page, "share");
      await page.waitForFunction(() => location.hash.startsWith("#p="));
      const link = await page.evaluate(() => location.href);
      const other = await opened(link);
      const work = await other.evaluate(() => JSON.parse(localStorage.getItem("gapilib-work")));
      assert.equal(work.files["levels.csv"], "t,level\n0,1.4\n2,1.2\n4,1.0\n6,0.8\n");
      report(name, `a link with the four scripts, model and data has ${link.length} characters`);
      await other.close();
      const { oneScript } = await import("./src/share.js");
      const native = [join(target, "release/gapi"), join(target, "debug/gapi")].find(existsSync);
      const script = oneScript(work.files, work.main), folder = mkdtempSync(join(tmpdir(), "gapilib-"));
      writeFileSync(join(folder, "GAPILib.mos"), script);
      await click(page, "run");
      await ended(page);
      const own = /objective +(.*)/.exec(await text(page, "text"))[1];
      if (native) {
        // The second run finds what the first has written; the third, a table of the user's own.
        for (const ownTable of [null, null, "t,level\n0,1.4\n2,1.2\n4,1.0\n6,0.81\n"]) {
          if (ownTable) {
            unlinkSync(join(folder, "results/GAPILib/files_made.txt"));
            writeFileSync(join(folder, "levels.csv"), ownTable);
          }
          const { stdout, stderr, status } = spawnSync(native, ["run", "GAPILib.mos"], { cwd: folder, encoding: "utf8" });
          assert.deepEqual([status, stderr], [0, ""]);
          assert.match(stdout, ownTable ? /^levels.csv is used as it is: it differs from the table in this script\n/ : /^\nIdentified parameters of Tank/);
          assert.equal(/objective +(.*)/.exec(stdout)[1] === own, !ownTable);
        }
      }
      assert.equal(await text(page, "download-as"), "6 files as one script");
      assert.equal(await page.$eval("#download-as", (element) => element.previousElementSibling.id), "download");
      await page.evaluate(() => { HTMLAnchorElement.prototype.click = () => {}; document.getElementById("download").click(); });
      assert.equal(await text(page, "said"), "GAPILib.mos holds all 6 files. Run it with: gapi run GAPILib.mos");
      await closed(page);
    });

    test("one file runs without a server", async () => {
      const page = await opened(pathToFileURL(join(web, "play.html")).href);
      const paint = await page.evaluate(() => performance.getEntriesByType("paint").find(({ name }) => name === "first-contentful-paint")?.startTime);
      report(name, `one file: first contentful paint ${paint?.toFixed(0)} ms`);
      await click(page, "run");
      await ended(page);
      assert.match(await text(page, "text"), /Identified parameters of Tank/);
      await closed(page);
    });

    test("the examples of the guide run where they stand", { skip: existsSync(join(book, "first_fit.html")) ? false : "no book: mdbook build docs" }, async () => {
      const library = await serve(book);
      const page = await browser.newPage();
      await page.goto(`http://localhost:${library.address().port}/first_fit.html`);
      const button = await page.waitForSelector("button.run-example");
      await button.evaluate((button) => button.click());
      await page.waitForFunction(() => /written to/.test(document.querySelector("button.run-example + pre").textContent), { timeout: 60000 });
      assert.match(await page.$eval("button.run-example + pre", (pre) => pre.textContent), /tau +3.9701 +3.9917/);
      await button.evaluate((button) => button.scrollIntoView());
      await page.screenshot({ path: join(pictures, `${name}-book.png`) });
      await page.goto(`http://localhost:${library.address().port}/polarization_curve.html`);
      const second = await page.waitForSelector("button.run-example");
      await second.evaluate((button) => button.click());
      await page.waitForFunction(() => /written to/.test(document.querySelector("button.run-example + pre").textContent), { timeout: 60000 });
      assert.match(await page.$eval("button.run-example + pre", (pre) => pre.textContent), /iL +2.0283/);
      await page.close();
      library.close();
    });

    test("nothing that axe finds, and nothing wider than a phone", async () => {
      const axe = readFileSync(join(here, "node_modules/axe-core/axe.min.js"), "utf8");
      for (const [width, height, dark] of [[1280, 800, false], [1280, 800, true], [390, 844, false], [390, 844, true]]) {
        const page = await opened(at, { width, height, dark });
        const look = async (state) => {
          await page.evaluate(axe);
          const { violations } = await page.evaluate(() => globalThis.axe.run(document, { iframes: false }));
          const found = violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.target.join(" ") + " " + (node.any[0]?.message ?? "")).join("; ")}`);
          assert.deepEqual(found, [], `${width} ${dark ? "dark" : "light"} ${state}`);
          const wide = await page.evaluate(() => document.documentElement.scrollWidth);
          assert.ok(wide <= width, `${wide} in ${width}, ${state}`);
          await page.screenshot({ path: join(pictures, `${name}-${width}${dark ? "-dark" : ""}-${state}.png`) });
        };
        const background = await page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).slice(0, 3).map(Number));
        assert.ok(dark === background.every((part) => part < 80), `${dark ? "dark" : "light"}: ${background}`);
        await look("edit");
        await click(page, "run");
        await ended(page);
        for (const tab of ["live", "output", "results", "steps"]) {
          await click(page, "tab-" + tab);
          if (tab === "steps") await wait(1000);
          await look(tab);
        }
        await open(page, "lesson 4");
        await look("lesson");
        await closed(page);
      }
    });
  });
}
