// The editor: one view, a state for each file, so that undo and the place are the file's own.

import { EditorState } from "@codemirror/state";
import { EditorView, keymap, lineNumbers, highlightActiveLine, drawSelection } from "@codemirror/view";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { HighlightStyle, bracketMatching, syntaxHighlighting } from "@codemirror/language";
import { autocompletion, completionKeymap } from "@codemirror/autocomplete";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { setDiagnostics, lintGutter } from "@codemirror/lint";
import { tags } from "@lezer/highlight";
import { modelica } from "./modelica.js";

// Colours are the page's variables, so that light and dark follow the reader's choice.
const COLOURS = HighlightStyle.define([
  { tag: tags.keyword, color: "var(--keyword)", fontWeight: "600" },
  { tag: tags.comment, color: "var(--comment)", fontStyle: "italic" },
  { tag: tags.string, color: "var(--string)" },
  { tag: [tags.number, tags.bool], color: "var(--number)" },
  { tag: tags.typeName, color: "var(--type)" },
  { tag: tags.function(tags.variableName), color: "var(--function)" },
]);
const LOOK = EditorView.theme({
  "&": { height: "100%", fontSize: "14px", backgroundColor: "var(--paper)", color: "var(--ink)" },
  ".cm-scroller": { fontFamily: "ui-monospace, monospace", lineHeight: "1.45" },
  ".cm-gutters": { backgroundColor: "var(--plain)", color: "var(--soft)", border: "none" },
  ".cm-activeLine": { backgroundColor: "var(--active)" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  "&.cm-focused .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "var(--selection) !important" },
  ".cm-panels, .cm-tooltip": { backgroundColor: "var(--plain)", color: "var(--ink)" },
  ".cm-tooltip-autocomplete > ul > li[aria-selected]": { backgroundColor: "var(--blue)", color: "var(--paper)" },
});

/** The editor in an element; `onchange` gets the text of the file that is shown after each change. */
export class Editor {
  #states = new Map();
  #view;
  #shown = null;
  #onchange;

  constructor(parent, onchange) {
    this.#onchange = onchange;
    this.#view = new EditorView({ parent, state: this.#state("", "") });
  }

  #state(path, text) {
    const language = /\.mos?$/.test(path) ? [modelica] : [];
    return EditorState.create({
      doc: text,
      extensions: [
        lineNumbers(), history(), drawSelection(), bracketMatching(), highlightActiveLine(), highlightSelectionMatches(),
        autocompletion({ activateOnTyping: false }), lintGutter(), syntaxHighlighting(COLOURS), LOOK, EditorView.lineWrapping,
        // Escape and then Tab leaves the editor.
        keymap.of([...completionKeymap, ...defaultKeymap, ...historyKeymap, ...searchKeymap, indentWithTab]),
        EditorView.contentAttributes.of({ "aria-label": path ? `Text of ${path}` : "Text", tabindex: "0" }),
        EditorView.updateListener.of((update) => update.docChanged && this.#onchange(update.state.doc.toString())),
        ...language,
      ],
    });
  }

  /** Forgets all files. */
  clear() {
    this.#states.clear();
    this.#shown = null;
  }

  /** Shows a file. */
  show(path, text) {
    if (this.#shown === path) return;
    if (this.#shown !== null) this.#states.set(this.#shown, this.#view.state);
    const known = this.#states.get(path);
    this.#view.setState(known && known.doc.toString() === text ? known : this.#state(path, text));
    this.#shown = path;
  }

  /** Goes to a line and column, from 1. */
  go(line, column) {
    const at = this.#place(line, column);
    this.#view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: "center" }) });
    this.#view.focus();
  }

  /** Scrolls to a line, from 1, and leaves the focus where it is. */
  look(line) {
    const at = this.#place(line, 1);
    this.#view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: "center" }) });
  }

  /** Marks places with what is wrong there. */
  mark(wrong) {
    const diagnostics = wrong.map(({ line, column, message, severity }) => {
      const from = this.#place(line, column), word = /^\w+/.exec(this.#view.state.sliceDoc(from, from + 80));
      return { from, to: Math.min(this.#view.state.doc.length, from + (word ? word[0].length : 1)), severity, message };
    });
    this.#view.dispatch(setDiagnostics(this.#view.state, diagnostics));
  }

  #place(line, column) {
    const { doc } = this.#view.state, of = doc.line(Math.min(Math.max(line, 1), doc.lines));
    return Math.min(of.from + Math.max(column - 1, 0), of.to);
  }
}
