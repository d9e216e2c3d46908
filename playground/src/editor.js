// The editor: scene text with colours, squiggles under what the compiler reports, and fixes.

import { closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching, indentOnInput, indentUnit } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { EditorState } from "@codemirror/state";
import {
  EditorView, drawSelection, highlightActiveLine, highlightActiveLineGutter, keymap, lineNumbers,
} from "@codemirror/view";
import { completions } from "./completions.js";
import { language } from "./language.js";

/// Makes the editor. `changed` is called after each edit of the text.
export function makeEditor(parent, text, changed) {
  const extensions = [
    lineNumbers(), highlightActiveLine(), highlightActiveLineGutter(), history(), drawSelection(),
    indentUnit.of("  "), indentOnInput(), bracketMatching(), closeBrackets(), lintGutter(),
    highlightSelectionMatches(), language(), completions(),
    // Escape and then Tab leaves the editor, as CodeMirror documents.
    keymap.of([
      ...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap,
      ...completionKeymap, ...lintKeymap, indentWithTab,
    ]),
    EditorView.contentAttributes.of({ "aria-label": "Scene", spellcheck: "false" }),
    EditorView.updateListener.of((update) => update.docChanged && changed()),
  ];
  const state = (doc) => EditorState.create({ doc, extensions });
  const view = new EditorView({ state: state(text), parent });
  return {
    text: () => view.state.doc.toString(),
    focus: () => view.focus(),
    /// Replaces the whole text. The old text can be brought back with undo.
    open(text) {
      const changes = { from: 0, to: view.state.doc.length, insert: text };
      view.dispatch({ changes, selection: { anchor: 0 }, scrollIntoView: true });
    },
    report: (rows) => view.dispatch(setDiagnostics(view.state, rows.map((row) => shown(view, row)))),
    /// Moves the cursor to what a row is about.
    reveal(row) {
      const { from } = range(view.state.doc, row);
      view.dispatch({ selection: { anchor: from }, scrollIntoView: true });
      view.focus();
    },
    /// Makes the changes of a fix.
    apply(fix) {
      view.dispatch({ changes: changes(view.state.doc, fix) });
      view.focus();
    },
  };
}

function shown(view, row) {
  const { doc } = view.state;
  const { from, to } = range(doc, row);
  const actions = row.fixes.map((fix) => {
    const all = changes(doc, fix);
    // The row has moved if something was typed above it.
    const moved = (by) => all.map((it) => ({ ...it, from: it.from + by, to: it.to + by }));
    return { name: fix.title, apply: (view, now) => view.dispatch({ changes: moved(now - from) }) };
  });
  return {
    from, to, actions,
    severity: row.severity,
    source: row.code ?? undefined,
    message: row.help ? `${row.message}\n${row.help}` : row.message,
  };
}

/// Returns the changes of a fix of the compiler.
function changes(doc, { edits }) {
  return edits.map((edit) => ({ ...range(doc, edit), insert: edit.text }));
}

/// Returns the offsets of a range of the compiler, within the text. The compiler counts characters,
/// and the editor counts units of UTF-16.
function range(doc, { line, column, end_line, end_column }) {
  const offset = (line, column) => {
    if (line < 1) return 0;
    if (line > doc.lines) return doc.length;
    const { from, text } = doc.line(line);
    return from + [...text].slice(0, column - 1).join("").length;
  };
  const from = offset(line, column);
  return { from, to: Math.max(from, offset(end_line, end_column)) };
}
