// The TextMate grammar gives each word the role that the compiler gives it. All scenes of the
// repository are compared with the semantic tokens of `sdfc lsp`.

import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import { createRequire } from "node:module";
import { after, test } from "node:test";
import oniguruma from "vscode-oniguruma";
import textmate from "vscode-textmate";
import { Client, root } from "./client.mjs";

const require = createRequire(import.meta.url);
const wasm = await readFile(require.resolve("vscode-oniguruma/release/onig.wasm"));
await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.byteLength));
const registry = new textmate.Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async () => {
    const path = `${root}/editors/vscode/syntaxes/sdf.tmLanguage.json`;
    return textmate.parseRawGrammar(await readFile(path, "utf8"), path);
  },
});
const grammar = await registry.loadGrammar("source.sdf");

/** What the innermost scope of a word must begin with, by its semantic role. */
const name = /^(entity\.name\.function|variable|support\.type|constant\.language|meta|constant\.other\.caps)/;
const ROLES = {
  comment: /^comment/,
  keyword: /^(storage|keyword\.control|support\.type|constant\.language\.boolean)/,
  number: /^(constant\.(numeric|other\.color))/,
  string: /^string/,
  operator: /^keyword\.operator/,
  function: name, class: name, macro: name, type: name, parameter: name, variable: name, property: name,
};

/** The innermost scope at each column of each line. */
function scopes(text) {
  let stack = textmate.INITIAL;
  return text.split("\n").map((line) => {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, stack);
    stack = ruleStack;
    return (column) => tokens.findLast((it) => it.startIndex <= column)?.scopes.at(-1) ?? "";
  });
}

const folder = await Client.start(root);
after(() => folder.end());
const { tokenTypes } = folder.server.capabilities.semanticTokensProvider.legend;

async function scenes(at) {
  const found = [];
  for (const entry of await readdir(at, { withFileTypes: true, recursive: true })) {
    const path = `${entry.parentPath ?? entry.path}/${entry.name}`;
    if (entry.name.endsWith(".sdf") && !path.includes("node_modules")) found.push(path);
  }
  return found.sort();
}

test("every word of every scene has its role", async () => {
  const paths = [];
  for (const at of ["examples", "crates/lang/std", "tests"]) paths.push(...await scenes(`${root}/${at}`));
  assert.ok(paths.length > 150, `${paths.length} scenes`);
  const wrong = [];
  let words = 0;
  for (const path of paths) {
    const text = (await readFile(path, "utf8")).replaceAll("\r\n", "\n");
    const uri = `file://${path}`;
    folder.open(uri, text);
    const { data } = await folder.ask("textDocument/semanticTokens/full", { textDocument: { uri } });
    folder.notify("textDocument/didClose", { textDocument: { uri } });
    const [lines, at] = [text.split("\n"), scopes(text)];
    let [line, column] = [0, 0];
    for (let i = 0; i < data.length; i += 5) {
      if (data[i] > 0) column = 0;
      line += data[i];
      column += data[i + 1];
      const role = tokenTypes[data[i + 3]];
      words += 1;
      if (ROLES[role].test(at[line](column))) continue;
      const word = lines[line].slice(column, column + data[i + 2]);
      wrong.push(`${path}:${line + 1}: ${word} is ${role}, not ${at[line](column)}: ${lines[line].trim()}`);
    }
  }
  assert.ok(words > 10_000, `${words} words`);
  assert.equal(wrong.length, 0, `${wrong.length} of ${words}:\n${wrong.slice(0, 30).join("\n")}`);
});
