// Completion of the names of the library, with their documentation, and of the names in the text.

import { autocompletion, completeAnyWord } from "@codemirror/autocomplete";
// The bundler makes this list from the sources of the library.
import library from "library";

const options = library.map(({ name, signature, doc }) => ({
  label: name,
  type: "function",
  detail: signature,
  info: doc || undefined,
}));

const known = new Set(library.map(({ name }) => name));

function libraryNames(context) {
  const word = context.matchBefore(/[A-Za-z_]\w*/);
  if (!word || (word.text.length < 2 && !context.explicit)) return null;
  const before = context.matchBefore(/(?:\/\/|").*/);
  return before ? null : { from: word.from, options, validFor: /^\w*$/ };
}

/// Names in the text that are not in the library.
async function ownNames(context) {
  const found = await completeAnyWord(context);
  return found && { ...found, options: found.options.filter(({ label }) => !known.has(label)) };
}

export const completions = () => autocompletion({ override: [libraryNames, ownNames] });
