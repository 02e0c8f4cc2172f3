// Makes the page: `play/` to be served, and `play.html`, one file that needs neither server nor
// network. Called by `build`, which makes the module before: `node build.mjs FOLDER`.

import { gzipAsync } from "@gfx/zopfli";
import { build } from "esbuild";
import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { join, relative } from "node:path";
import { gzipSync } from "node:zlib";

const here = import.meta.dirname;
const project = join(here, "../..");
const out = process.argv[2];
const text = (path) => readFileSync(path, "utf8");

/** The keywords of the grammar: `"a" ~ ("lgorithm" | "nd")` are `algorithm` and `and`. */
function keywords() {
  const rules = text(join(project, "grammar/lexical.pest")).matchAll(/^keyword_\w+ = _\{([^}]*)\}/gm);
  const found = [];
  for (const [, body] of rules) {
    for (const [, head, rest, alone] of body.matchAll(/"(\w+)" ~ \(([^)]*)\)|"(\w+)"/g)) {
      if (alone) found.push(alone);
      else for (const [, tail] of rest.matchAll(/"(\w+)"/g)) found.push(head + tail);
    }
  }
  if (!found.includes("algorithm") || !found.includes("within") || found.length < 50) throw new Error(`keywords: ${found}`);
  return found.sort();
}

/** The files that a chapter of the guide tells to save. */
function chapter(name) {
  const blocks = text(join(project, "docs/src", name)).matchAll(/^```\w+,file=(\S+)\n([^]*?)^```/gm);
  return Object.fromEntries([...blocks].map(([, file, content]) => [file, content]));
}

function under(...folders) {
  const files = {};
  for (const folder of folders) {
    for (const entry of readdirSync(join(project, folder), { withFileTypes: true, recursive: true })) {
      const path = join(entry.parentPath, entry.name);
      if (entry.isFile() && /\.(mo|order)$/.test(path)) files[relative(project, path)] = text(path);
    }
  }
  return files;
}

/** What can be opened: a small problem, and those of the paper. */
function examples() {
  const tank = chapter("scripts.md");
  const own = chapter("first_fit.md");
  const scripts = Object.fromEntries(["GAPILib_INI", "GAPILib", "GAPILib_CYCLE", "GAPILib_SIM_SISO"].map((name) => [`scripts/${name}.mos`, text(join(project, `scripts/${name}.mos`))]));
  const curve = "data/ecsim_nafion112/c12_n20_rh50_p15psig";
  // The tables of the editor are text.
  const initial = scripts["scripts/GAPILib_INI.mos"].replace(`"${curve}.mat", "i", "V"`, `"${curve}.csv", "i_A_per_cm2", "V"`);
  if (!initial.includes(".csv")) throw new Error("the data of case 4.1");
  scripts["scripts/GAPILib_INI.mos"] = initial;
  return [
    { title: "A draining tank: the four scripts", main: "GAPILib.mos", edit: "GAPILib_INI.mos", files: tank },
    { title: "A capacitor that discharges: one script", main: "fit.mos", files: own },
    { title: "A fuel cell's polarization curve (case 4.1 of the paper)", main: "scripts/GAPILib.mos", edit: "scripts/GAPILib_INI.mos",
      files: { ...scripts, [`scripts/${curve}.csv`]: text(join(project, `scripts/${curve}.csv`)), ...under("models/CaseStudies") } },
  ];
}

const values = { examples: () => `export const EXAMPLES = ${JSON.stringify(examples())};`, keywords: () => `export const KEYWORDS = ${JSON.stringify(keywords())};` };
const made = {
  name: "made",
  setup(builder) {
    builder.onResolve({ filter: /^(examples|keywords)$/ }, ({ path }) => ({ path, namespace: "made" }));
    builder.onLoad({ filter: /.*/, namespace: "made" }, ({ path }) => ({ contents: values[path](), loader: "js" }));
  },
};
/** Folders of the packages that are in a bundle. */
const packages = new Set();
async function bundle(entry) {
  const { outputFiles, metafile } = await build({ entryPoints: [join(here, "src", entry)], bundle: true, minify: true, write: false, metafile: true, absWorkingDir: here, format: "iife", target: "es2022", plugins: [made], legalComments: "eof" });
  for (const input of Object.keys(metafile.inputs)) {
    const [, folder] = /(node_modules\/(?:@[^/]+\/)?[^/]+)\//.exec(input) ?? [];
    if (folder) packages.add(folder);
  }
  return outputFiles[0].text;
}
/** The licences of the crates that are in the module, as cargo resolves them for it. */
function crateLicences() {
  const manifest = join(project, "bindings/web/Cargo.toml");
  const cargo = (...given) => {
    const { stdout, status, stderr } = spawnSync("cargo", [...given, "--manifest-path", manifest], { encoding: "utf8", maxBuffer: 1 << 28 });
    if (status !== 0) throw new Error(`cargo ${given[0]}: ${stderr}`);
    return stdout;
  };
  const metadata = JSON.parse(cargo("metadata", "--format-version", "1", "--locked", "--filter-platform", "wasm32-unknown-unknown"));
  const used = new Set(cargo("tree", "--locked", "--target", "wasm32-unknown-unknown", "--edges", "normal", "--prefix", "none", "--format", "{p}").split("\n").map((line) => line.split(" ").slice(0, 2).join(" ")));
  const crates = metadata.packages.filter(({ name, version }) => used.has(`${name} v${version}`)).sort((a, b) => (a.name < b.name ? -1 : 1));
  const all = crates.map(({ name, version, license, manifest_path }) => {
    const folder = join(manifest_path, "..");
    const own = name.startsWith("gapilib");
    const files = readdirSync(own ? project : folder).filter((file) => /^(licen[cs]e|copying|notice|unlicense)/i.test(file));
    // Some crates carry the name of their licence only: its text is that of others in this file.
    return [`${name} ${version} (${license ?? "see below"})`, ...files.filter((file) => statSync(join(own ? project : folder, file)).isFile()).map((file) => text(join(own ? project : folder, file)))].join("\n\n");
  });
  if (all.length < 20) throw new Error(`licences of ${all.length} crates`);
  return all;
}
/** The licences of all that is on the page, which go wherever it goes. */
function licences() {
  const all = [...packages].sort().map((folder) => {
    const file = readdirSync(join(here, folder)).find((name) => /^licen[cs]e/i.test(name));
    if (!file) throw new Error(`${folder} has no licence`);
    return `${folder.slice("node_modules/".length)}\n\n${text(join(here, folder, file))}`;
  });
  if (all.length < 5) throw new Error(`licences of ${all.length} packages`);
  return [...all, ...crateLicences()].join("\n\n----\n\n");
}

/** Texts within a script element. */
const inline = (script) => script.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const [page, worker, examplesRunner] = await Promise.all(["play.js", "worker.js", "run_examples.js"].map(bundle));
const style = text(join(here, "style.css")), template = text(join(here, "index.html"));
// Zopfli writes gzip that is a twentieth smaller, in about a minute.
const module = Buffer.from(await gzipAsync(readFileSync(join(out, "gapilib.wasm")), { numiterations: 1 }));
const filled = (head, scripts) => template.replace("<!--style-->", () => head).replace("<!--script-->", () => scripts);

mkdirSync(join(out, "play"), { recursive: true });
const put = (name, content) => writeFileSync(join(out, name), content);
put("play/index.html", filled(`<style>${style}</style>`, '<script src="play.js" defer></script>'));
put("play/play.js", page);
put("play/worker.js", worker);
put("play/run_examples.js", examplesRunner);
put("play/gapilib.wasm.gz", module);
const notices = licences();
put("play/licences.txt", notices);
// The program is behind the page, which is painted while it is read.
put("play.html", filled(`<style>${style}</style>`,
  `<script type="text/plain" id="worker-source">${inline(worker)}</script>\n<script>addEventListener("DOMContentLoaded", () => {${inline(page)}});</script>\n<script type="text/plain" id="licences">${inline(notices)}</script>\n<script type="text/plain" id="module">${module.toString("base64")}</script>`));
const size = (name) => `${name} ${gzipSync(readFileSync(join(out, name)), { level: 9 }).length}`;
console.log("bytes, compressed:", ["play/index.html", "play/play.js", "play/worker.js", "play/gapilib.wasm.gz", "play.html"].map(size).join(", "));
