// In the guide: the examples of a chapter can be edited and run where they stand. Every command
// `gapi run` or `gapi identify` below files that the chapter tells to save gets a button.

import { Engine } from "./engine.js";

const engine = new Engine();

/** The files of the chapter in front of an element, as the reader has changed them. */
function filesBefore(element) {
  const files = {};
  for (const code of document.querySelectorAll("code[class*='file=']")) {
    const isBefore = code.compareDocumentPosition(element) & Node.DOCUMENT_POSITION_FOLLOWING;
    const name = [...code.classList].find((one) => one.startsWith("file="));
    if (isBefore && name) files[name.slice("file=".length)] = code.innerText;
  }
  return files;
}

/** What a command of the guide runs: a script, or a problem file by a script of one line. */
function commandOf(line) {
  const [, command, file] = /^\$ gapi (run|identify) (\S+\.(?:mos|toml))\s*$/.exec(line) ?? [];
  if (!command) return null;
  return command === "run" ? { file, script: file, more: {} }
    : { file, script: "identify.mos", more: { "identify.mos": `(values, fitness, deviations) := identify("${file}");\n` } };
}

async function run(button, output, { script, more }) {
  button.disabled = true;
  output.hidden = false;
  output.textContent = "Loading ...";
  let text = "";
  engine.onevent = ({ print, eprint, view }) => {
    text += (print ?? eprint ?? "").replaceAll("/memory/", "");
    output.textContent = text + (view ? `generation ${view.progress.done}` : "");
  };
  try {
    await engine.ask("run", { script, files: { ...filesBefore(button), ...more }, options: {} });
    output.textContent = text;
  } catch (error) {
    output.textContent = `${text}\nerror: ${error.message}`;
  }
  button.disabled = false;
}

/** Above each file its name, and its text to be edited. */
function nameFile(code) {
  const name = [...code.classList].find((one) => one.startsWith("file=")).slice("file=".length);
  const title = document.createElement("span");
  title.className = "example-file";
  title.textContent = `${name} (can be edited)`;
  code.closest("pre").before(title);
  code.contentEditable = "plaintext-only";
  code.spellcheck = false;
  code.setAttribute("role", "textbox");
  code.setAttribute("aria-multiline", "true");
  code.setAttribute("aria-label", name);
}

function begin() {
  for (const code of document.querySelectorAll("code.language-console")) {
    for (const line of code.textContent.split("\n")) {
      const command = commandOf(line);
      if (!command || filesBefore(code)[command.file] === undefined) continue;
      const button = document.createElement("button"), output = document.createElement("pre");
      button.className = "run-example";
      button.textContent = `Run ${command.file} here`;
      output.hidden = true;
      output.tabIndex = 0;
      output.setAttribute("role", "status");
      button.addEventListener("click", () => run(button, output, command));
      code.closest("pre").after(button, output);
    }
  }
  document.querySelectorAll("code[class*='file=']").forEach(nameFile);
}
if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", begin);
else begin();
