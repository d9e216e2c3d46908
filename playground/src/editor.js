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
    /// Replaces the whole text and forgets its history.
    open(text) {
      view.setState(state(text));
      changed();
    },
    report: (rows) => view.dispatch(setDiagnostics(view.state, rows.map((row) => shown(view, row)))),
    /// Moves the cursor to what a row is about.
    reveal(row) {
      const { from } = range(view.state.doc, row);
      view.dispatch({ selection: { anchor: from }, scrollIntoView: true });
      view.focus();
    },
    /// Replaces the range of a row.
    replace(row, insert) {
      view.dispatch({ changes: { ...range(view.state.doc, row), insert } });
      view.focus();
    },
  };
}

function shown(view, row) {
  const { from, to } = range(view.state.doc, row);
  const name = row.fix === "" ? "Remove it" : `Replace with ${row.fix}`;
  const apply = (view, from, to) => view.dispatch({ changes: { from, to, insert: row.fix } });
  return {
    from, to,
    severity: row.severity,
    source: row.code ?? undefined,
    message: row.help ? `${row.message}\n${row.help}` : row.message,
    actions: row.fix === undefined ? [] : [{ name, apply }],
  };
}

/// Returns the offsets of a row of the compiler, within the text. The compiler counts characters,
/// and the editor counts units of UTF-16.
function range(doc, row) {
  const offset = (line, column) => {
    if (line < 1) return 0;
    if (line > doc.lines) return doc.length;
    const { from, text } = doc.line(line);
    return from + [...text].slice(0, column - 1).join("").length;
  };
  const from = offset(row.line, row.column);
  return { from, to: Math.max(from, offset(row.end_line, row.end_column)) };
}
