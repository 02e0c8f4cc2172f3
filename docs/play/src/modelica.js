// Modelica and its scripts for the editor. The keywords are those of `grammar/lexical.pest`; the build
// reads them there.

import { StreamLanguage } from "@codemirror/language";
import { KEYWORDS } from "keywords";

const WORDS = new Set(KEYWORDS);
const CONSTANTS = new Set(["true", "false"]);
const TYPES = new Set(["Real", "Integer", "Boolean", "String"]);

/** How the text of a stream goes on: the name of its style, or `null`. */
function token(stream, state) {
  if (state.comment) {
    if (stream.skipTo("*/")) { stream.match("*/"); state.comment = false; } else stream.skipToEnd();
    return "comment";
  }
  if (state.string) return string(stream, state);
  if (stream.eatSpace()) return null;
  if (stream.match("//")) { stream.skipToEnd(); return "comment"; }
  if (stream.match("/*")) { state.comment = true; return token(stream, state); }
  if (stream.eat('"')) { state.string = true; return string(stream, state); }
  if (stream.match(/^(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?/)) return "number";
  if (stream.match(/^'([^'\\]|\\.)*'/)) return "variableName";
  const word = stream.match(/^[A-Za-z_]\w*/);
  if (word) {
    if (CONSTANTS.has(word[0])) return "bool";
    if (WORDS.has(word[0])) return "keyword";
    if (TYPES.has(word[0])) return "typeName";
    return stream.match(/^\s*\(/, false) ? "variableName.function" : "variableName";
  }
  stream.next();
  return "operator";
}

function string(stream, state) {
  while (!stream.eol()) {
    const letter = stream.next();
    if (letter === "\\") stream.next();
    else if (letter === '"') { state.string = false; break; }
  }
  return "string";
}

const INDENTS = /^\s*(model|class|function|package|record|block|equation|algorithm|for|while|if|when|then|else|elseif|loop)\b/;

/** The language of `.mo` and `.mos` files. */
export const modelica = StreamLanguage.define({
  name: "modelica",
  startState: () => ({ comment: false, string: false }),
  token,
  indent: (_, textAfter, context) => (/^\s*end\b/.test(textAfter) ? Math.max(0, context.lineIndent(context.pos, -1) - context.unit) : null),
  languageData: { commentTokens: { line: "//", block: { open: "/*", close: "*/" } }, autocomplete: [...WORDS, ...TYPES].map((label) => ({ label, type: "keyword" })), indentOnInput: INDENTS },
});
