// The playground: an editor, the picture of its scene, and what belongs to them.

import { CompilerClient } from "./compiler.js";
import { PARTS, TARGETS, exported, save, standalone } from "./exports.js";
import { FIRST, fillGallery, source as exampleSource } from "./gallery.js";
import { fromFragment, toFragment } from "./link.js";
import { Stage } from "./stage.js";
import * as webgl2 from "./webgl2.js";
import * as webgpu from "./webgpu.js";

const find = (id) => document.getElementById(id);
const query = new URLSearchParams(location.search);
const calm = matchMedia("(prefers-reduced-motion: reduce)").matches || query.has("time");
const DRAFT = "sdfc-draft";
const THEME = "sdfc-theme";
/// After this many milliseconds of drawing the page offers to stop it.
const SLOW = 500;
/// A compilation that has taken more milliseconds than this is ended by the next edit.
const LONG = 1500;

const times = {};
/// The editor, and before it is loaded an object with the first text.
let editor;
/// What the compiler writes: for the backend that the drawing worker has opened, and before that
/// for the one that it will probably open.
let target = isLikely(webgpu) ? webgpu.target : webgl2.target;
let opened;
let isOpen;

function isLikely({ id }) {
  return query.get("backend") === id || (navigator.gpu && query.get("backend") === null);
}

const compiler = new CompilerClient();
const makeWorker = () => new Worker(new URL("draw.worker.js", import.meta.url), { type: "module" });
const stage = new Stage(
  { canvas: find("picture"), form: find("params"), bar: find("clock"), play: find("play"), time: find("time") },
  {
    opened(message) {
      ({ target } = message);
      times.name = message.name;
      opened();
    },
    fixedChanged: () => compile(),
    built({ milliseconds }) {
      times.built = milliseconds;
      tell();
    },
    progress(part) {
      if (part < 1) say(`drawing: ${Math.round(100 * part)} %`);
    },
    asked() {
      setState("busy");
      setBusy(true);
    },
    drawn({ isWhole, isLast, moves, milliseconds }) {
      times.drawn = milliseconds;
      if (!stage.clock.isPlaying && !(isWhole && isLast && !moves)) return;
      setBusy(false);
      notice(complaint);
      setState(find("problems").querySelector(".error") ? "errors" : "drawn");
      tell();
    },
    refused: ({ reason }) => failed(`The browser refused the shader: ${reason}`),
    lost({ reason }) {
      stage.picture.stop();
      opened();
      failed(`The GPU was lost, or there is none: ${reason}`);
    },
  },
  makeWorker,
  query.get("backend"),
);

/// The state is in the page and, with the time when it began, among the marks of the browser.
function setState(state) {
  document.body.dataset.state = state;
  performance.clearMarks(state);
  performance.mark(state);
}

function say(text) {
  find("status").textContent = text;
}

function tell() {
  const ms = (value) => `${Math.round(value)} ms`;
  const parts = [times.name];
  if (times.compiled !== undefined) parts.push(`compiled in ${ms(times.compiled)}`);
  if (times.built !== undefined) parts.push(`shader built in ${ms(times.built)}`);
  if (times.drawn !== undefined) parts.push(`drawn in ${ms(times.drawn)}`);
  say(parts.join(" · "));
}

/// What is wrong with the link or the example that was opened. It stays until the next edit.
let complaint = null;

function notice(text) {
  find("notice").hidden = text === null;
  find("notice").firstElementChild.textContent = text ?? "";
  find("again").textContent = complaint !== null && text === complaint ? "Close" : "Draw again";
}

function complain(error) {
  complaint = error.message;
  notice(complaint);
}

function failed(text) {
  setBusy(false);
  notice(text);
  setState("failed");
}

let slow = null;
function setBusy(busy) {
  if (!busy) {
    clearTimeout(slow);
    slow = null;
    find("stop").hidden = true;
  } else {
    slow ??= setTimeout(() => (find("stop").hidden = false), SLOW);
  }
}

// Edits are compiled one after the other. Of the edits that wait, only the last is compiled.
let isCompiling = false;
let isOutdated = false;
let started = 0;
async function compile() {
  setState("busy");
  if (isCompiling) {
    isOutdated = true;
    // A long compilation is ended. A short one is not: while someone types, nothing would be shown.
    const run = started;
    const end = () => isCompiling && started === run && compiler.cancel();
    setTimeout(end, LONG - (performance.now() - started));
    return;
  }
  isCompiling = true;
  do {
    isOutdated = false;
    started = performance.now();
    try {
      await compileOnce();
    } catch (error) {
      if (!isOutdated) failed(error.message);
    }
  } while (isOutdated);
  isCompiling = false;
}

/// Starts the worker that draws. `isOpen` waits until it has a backend, or has found none.
function startDrawing() {
  isOpen = new Promise((resolve) => (opened = resolve));
  stage.picture.start();
}

async function compileOnce() {
  if (!stage.picture.isRunning) startDrawing();
  const source = editor.text();
  const compiledFor = (target) => compiler.compile(source, { ...target, name: "scene.sdf", values: stage.values });
  const waiting = setTimeout(() => say("compiling: an edit ends it"), LONG);
  // Without a backend the scene is compiled for its errors.
  const guess = target;
  const first = compiledFor(guess).finally(() => clearTimeout(waiting));
  const [found] = await Promise.all([first, isOpen]);
  const compiled = target.target === guess.target ? found : await compiledFor(target);
  const { text, reflection, diagnostics, milliseconds } = compiled;
  times.compiled = milliseconds;
  // Positions in an old text would be wrong.
  if (source === editor.text()) report(diagnostics);
  if (text === null) {
    if (!isOutdated) setState("errors");
    tell();
    return;
  }
  stage.show(source, text, reflection, !calm);
}

/// Shows the diagnostics in the editor and in the list below it.
function report(rows) {
  editor.report(rows);
  find("problems").replaceChildren(...rows.map((row) => {
    const item = document.createElement("li");
    item.className = row.severity;
    const where = document.createElement("button");
    where.className = "where";
    const head = document.createElement("b");
    head.textContent = [row.code ?? row.severity, row.line > 0 && `line ${row.line}`].filter(Boolean).join(", ");
    const help = document.createElement("small");
    help.textContent = row.help && ` ${row.help[0].toUpperCase()}${row.help.slice(1)}`;
    where.append(head, `: ${row.message}.`, help);
    where.addEventListener("click", () => editor.reveal(row));
    item.append(where);
    for (const fix of row.fixes.slice(0, 1)) {
      const button = document.createElement("button");
      button.className = "fix";
      button.textContent = fix.title;
      button.addEventListener("click", () => editor.apply(fix));
      item.append(button);
    }
    return item;
  }));
}

/// Shows another scene.
function open({ source, ...state }) {
  stage.reset(state);
  editor.open(source);
}

/// Returns the scene of the link, or of the query, or the last one that was written here.
async function startScene() {
  try {
    const shared = await fromFragment(location.hash);
    if (shared) return shared;
    if (query.has("example")) return { source: await exampleSource(query.get("example")) };
  } catch (error) {
    complain(error);
  }
  const draft = localStorage.getItem(DRAFT);
  return { source: draft ?? (await exampleSource(FIRST)) };
}

const shared = () => {
  const { values, camera, clock } = stage;
  return { source: editor.text(), values, camera, time: clock.time };
};

function connect() {
  find("again").addEventListener("click", () => {
    const draws = complaint === null;
    complaint = null;
    notice(null);
    if (draws) compile();
  });
  find("stop").addEventListener("click", () => {
    stage.picture.stop();
    stage.stopClock(stage.clock.time);
    failed("Drawing was stopped. The next edit draws again.");
    setState("stopped");
  });
  find("home").addEventListener("click", () => {
    find("picture").dispatchEvent(new KeyboardEvent("keydown", { key: "Home" }));
  });
  find("rewind").addEventListener("click", () => {
    stage.clock.set(0);
    find("time").value = "0.00";
    stage.redraw(false);
  });
  find("params").addEventListener("submit", (event) => event.preventDefault());
  find("share").addEventListener("click", share);
  find("open-gallery").addEventListener("click", () => {
    if (!find("pictures").hasChildNodes()) fillGallery(find("pictures"), choose);
    find("gallery").showModal();
  });
  connectTheme();
  connectExport();
  window.addEventListener("hashchange", async () => {
    try {
      const found = await fromFragment(location.hash);
      if (found) open(found);
    } catch (error) {
      complain(error);
    }
  });
}

async function choose(name) {
  find("gallery").close();
  try {
    const source = await exampleSource(name);
    history.replaceState(null, "", location.pathname);
    open({ source });
  } catch (error) {
    complain(error);
  }
}

async function share() {
  history.replaceState(null, "", await toFragment(shared()));
  try {
    await navigator.clipboard.writeText(location.href);
    say("The link is copied. It holds the scene, the params and the camera.");
  } catch {
    say("The link is in the address bar. It holds the scene, the params and the camera.");
  }
}

function connectTheme() {
  const theme = find("theme");
  const apply = () => (document.documentElement.style.colorScheme = theme.value);
  theme.value = localStorage.getItem(THEME) ?? "light dark";
  apply();
  theme.addEventListener("change", () => {
    localStorage.setItem(THEME, theme.value);
    apply();
  });
}

function connectExport() {
  const status = (text) => (find("export-status").textContent = text);
  find("target").append(...TARGETS.map((name) => new Option(name)));
  find("part").append(...Object.entries(PARTS).map(([name, title]) => new Option(title, name)));
  find("open-export").addEventListener("click", () => {
    status("");
    find("export").showModal();
  });
  const on = (id, work) => find(id).addEventListener("click", async () => {
    try {
      status((await work()) ?? "Saved.");
    } catch (error) {
      status(error.message);
    }
  });
  const shader = () => exported(compiler, shared(), { target: find("target").value, emit: find("part").value });
  on("save-shader", async () => {
    const { content, name } = await shader();
    save(content, name);
  });
  on("copy-shader", async () => {
    const { content } = await shader();
    if (typeof content !== "string") return "SPIR-V has no text to copy.";
    await navigator.clipboard.writeText(content);
    return "Copied.";
  });
  on("save-png", () => new Promise((done) => find("picture").toBlob((blob) => done(save(blob, "scene.png")))));
  on("save-page", async () => {
    save(await standalone(compiler, shared()), "scene.html", "text/html");
  });
  on("save-scene", async () => save(editor.text(), "scene.sdf"));
}

async function main() {
  startDrawing();
  const loading = import("./editor.js");
  const { source, ...state } = await startScene();
  // The first scene is compiled and drawn while the editor is loaded.
  let rows = [];
  editor = { text: () => source, report: (found) => (rows = found) };
  stage.reset(state);
  if (query.has("time")) stage.stopClock(Number(query.get("time")) || 0);
  const compiled = compile();
  const { makeEditor } = await loading;
  editor = makeEditor(find("editor"), source, () => {
    complaint = null;
    localStorage.setItem(DRAFT, editor.text());
    compile();
  });
  editor.report(rows);
  connect();
  await compiled;
}

main().catch((error) => failed(error.message));
