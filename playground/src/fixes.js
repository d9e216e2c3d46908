// Turns the suggestions of diagnostics into edits. A suggestion is a sentence; an edit is offered
// only if the compiler reports fewer errors after it.

const PATTERNS = [
  /^did you mean `([^`]+)`\?$/,
  /^write:? `([^`]+)`$/,
  /^call it: ([^`]*\))$/,
  /^write ([^` ]+)$/,
];
/// The number of errors for which an edit is looked for: each takes one or two compilations.
const MAX_ERRORS = 3;

/// Adds `fix`, the text that replaces the range of the row, to the rows that have one.
export function withFixes(compiler, source, options, rows) {
  const errors = rows.filter(({ severity }) => severity === "error");
  const count = errors.length;
  const fixes = new Map(errors.slice(0, MAX_ERRORS).map((row) => [row, fix(row)]));
  return rows.map((row) => (fixes.get(row) === undefined ? row : { ...row, fix: fixes.get(row) }));

  function fix(row) {
    if (row.line === 0 || row.file !== (options.name ?? "scene.sdf")) return undefined;
    return candidates(row).find((text) => {
      const { diagnostics } = compiler.compile(replaced(source, row, text), options);
      const left = diagnostics.filter(({ severity }) => severity === "error");
      return left.length < count || (count > 1 && !left.some((other) => same(other, row)) && left.length <= count);
    });
  }
}

const same = (a, b) => a.code === b.code && a.line === b.line && a.message === b.message;

function candidates({ help }) {
  return help.split("\n").flatMap((line) => {
    if (line === "remove it") return [""];
    const found = PATTERNS.map((pattern) => line.match(pattern)?.[1]).find(Boolean);
    return found ? [found] : [];
  });
}

function replaced(source, row, text) {
  const lines = source.split("\n");
  const before = [...(lines[row.line - 1] ?? "")].slice(0, row.column - 1).join("");
  const after = [...(lines[row.end_line - 1] ?? "")].slice(row.end_column - 1).join("");
  return [
    ...lines.slice(0, row.line - 1),
    before + text + after,
    ...lines.slice(row.end_line),
  ].join("\n");
}
