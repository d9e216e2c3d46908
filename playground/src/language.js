// The colours of scene text: a tokeniser with the tokens of section 2 of the language reference.

import { HighlightStyle, LanguageSupport, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { tags } from "@lezer/highlight";

// A test compares these words with those of the compiler.
const KEYWORDS = /^(?:let|param|fn|solid|region|shape|import|from|as|if|else|for|in)$/;
const CLAUSES = /^(?:exact|bound|lipschitz|bounds|material|intersect|copies|require)$/;
const ATOMS = /^(?:true|false|inf|pi|tau)$/;
const TYPES = /^(?:number|length|int|angle|bool|string|vec2|vec3|vec4|color|range|point|blend|pattern)$/;

export const sdf = StreamLanguage.define({
  name: "sdf",
  languageData: {
    commentTokens: { line: "//" },
    closeBrackets: { brackets: ["(", "[", "{", '"'] },
    indentOnInput: /^\s*[)\]}]$/,
  },
  startState: () => ({ depth: 0, declares: false }),
  token(stream, state) {
    if (stream.eatSpace()) return null;
    if (stream.match(/^\/\/\/?.*/)) return "comment";
    if (stream.match(/^"(?:[^"\\]|\\.)*"?/)) return "string";
    if (stream.match(/^#[A-Za-z0-9_]*/)) return "color";
    if (stream.match(/^[0-9]+(?:\.[0-9]+)?(?:e[+-]?[0-9]+)?[A-Za-z_]*/)) return "number";
    const word = stream.match(/^[A-Za-z_][A-Za-z0-9_]*/)?.[0];
    if (word) return kind(word, stream, state);
    const mark = stream.match(/^(?:\.\.\.?|->|[=!<>]=|&&|\|\||.)/)[0];
    if (/[([{]/.test(mark)) state.depth += 1;
    if (/[)\]}]/.test(mark)) state.depth = Math.max(0, state.depth - 1);
    return /[()[\]{},;:]/.test(mark) ? "punctuation" : "operator";
  },
  indent(state, after, { unit }) {
    return Math.max(0, state.depth - (/^\s*[)\]}]/.test(after) ? 1 : 0)) * unit;
  },
  tokenTable: { color: tags.color, name: tags.definition(tags.variableName), call: tags.function(tags.variableName), label: tags.labelName },
});

function kind(word, stream, state) {
  const declares = state.declares;
  state.declares = /^(?:let|param|fn|solid|region|shape)$/.test(word);
  if (KEYWORDS.test(word)) return "keyword";
  if (ATOMS.test(word)) return "atom";
  if (declares) return "name";
  if (stream.match(/^\s*:(?!:)/, false) && state.depth > 0) return "label";
  if (stream.match(/^\s*\(/, false)) return "call";
  if (CLAUSES.test(word) && state.depth === 0) return "keyword";
  return TYPES.test(word) ? "typeName" : "variableName";
}

/// The colour of each kind of token, by name. The page has a variable `--code-NAME` for each.
export const COLORS = [
  { tag: tags.comment, name: "comment", fontStyle: "italic" },
  { tag: [tags.keyword, tags.typeName], name: "keyword" },
  { tag: [tags.number, tags.atom, tags.color], name: "number" },
  { tag: tags.string, name: "string" },
  { tag: tags.function(tags.variableName), name: "call" },
  { tag: tags.labelName, name: "label" },
  { tag: tags.definition(tags.variableName), name: "name", fontWeight: "600" },
  { tag: [tags.operator, tags.punctuation], name: "mark" },
];

// The colours are variables of the page, so that they follow its theme.
const style = HighlightStyle.define(COLORS.map(({ name, ...rest }) => ({ ...rest, color: `var(--code-${name})` })));

export const language = () => [new LanguageSupport(sdf), syntaxHighlighting(style)];
