// A scene on its stage: the picture, its camera, its params and its clock.

import { paramBytes } from "../../examples/embed/reflection.js";
import { control, moved, still } from "./camera.js";
import { makeClock } from "./clock.js";
import { CLOCK, inputRows, lanesOf, showControls } from "./controls.js";
import { Picture } from "./picture.js";

/// Pictures have at most this many pixels per pixel of the style sheet.
const MAX_RATIO = 2;
/// After this many milliseconds without a change a picture counts as still.
const REST = 160;

// The text of a shader without the line that names its source.
const body = (text) => text.replace(/^\/\/ sdfc.*$/m, "");

/// True if two results of the compiler are drawn by the same program with the same lists.
function isSameProgram(a, b) {
  const [before, after] = [a, b].map(({ reflection }) => reflection.lists);
  return body(a.text) === body(b.text) && before.length === after.length
    && before.every((number, index) => number === after[index]);
}

/// `elements` has `canvas`, `form`, `bar` (of the clock), `play` and `time`. `events` has the
/// functions of a [`Picture`], and `fixedChanged` if fixed params can change.
export class Stage {
  values = {};
  camera = still();
  #scene = null;
  #isParallel = false;
  #elements;
  #events;
  #resting = 0;

  constructor(elements, events, makeWorker, only) {
    this.#elements = elements;
    this.#events = events;
    this.picture = new Picture(elements.canvas, events, makeWorker, only);
    this.clock = makeClock(() => {
      this.#showTime();
      this.redraw(true);
    });
    control(elements.canvas, this.camera, () => this.#change());
    elements.play.addEventListener("click", () => this.#play(!this.clock.isPlaying));
    elements.time.addEventListener("input", () => {
      this.#play(false);
      this.clock.set(Number(elements.time.value) || 0);
      this.#change();
    });
    new ResizeObserver(() => this.#fit() && this.#change()).observe(elements.canvas);
    this.#fit();
  }

  get hasScene() {
    return this.#scene !== null;
  }

  #fit() {
    const { canvas } = this.#elements;
    const ratio = Math.min(devicePixelRatio, MAX_RATIO);
    const size = (length) => Math.max(1, Math.round(length * ratio));
    return this.picture.resize(size(canvas.clientWidth), size(canvas.clientHeight));
  }

  /// Shows a compiled scene. `plays` starts the clock if the scene has just begun to use it.
  show(source, text, reflection, plays) {
    const uses = ({ params }) => params.some(({ param }) => CLOCK.includes(param));
    const moves = uses(reflection);
    const began = moves && !(this.#scene && uses(this.#scene.reflection));
    const next = { text, reflection };
    const isSame = this.#scene && isSameProgram(this.#scene, next) && this.picture.hasProgram;
    this.#scene = next;
    this.#isParallel = /\bcamera\s*\([^()]*\bheight\s*:/.test(source.replace(/\/\/.*/g, ""));
    const rows = inputRows(reflection).filter(({ isFixed }) => !isFixed || this.#events.fixedChanged);
    const changed = ({ isFixed }) => (isFixed ? this.#events.fixedChanged() : this.#change());
    showControls(this.#elements.form, rows, this.values, changed);
    this.#elements.bar.hidden = !moves;
    if (!moves) this.#play(false);
    // The controls leave the canvas another height. Its first frame has it already.
    this.#fit();
    // Camera and lights are no part of the shader: changing them builds nothing.
    if (isSame) this.redraw(false);
    else this.restart();
    if (began && plays) this.#play(true);
    this.#showTime();
  }

  /// Builds the shader again, for example after the device was lost.
  restart() {
    if (!this.#scene) return;
    const { text, reflection } = this.#scene;
    this.picture.show(text, reflection, this.#frame(false));
  }

  redraw(moves) {
    if (this.#scene) this.picture.draw(this.#frame(moves));
  }

  #frame(moves) {
    const { reflection } = this.#scene;
    const { width, height } = this.#elements.canvas;
    const { time, frame } = this.clock;
    const taken = inputRows(reflection).map((row) => [row.param, lanesOf(row, this.values)]);
    const params = paramBytes(reflection, { ...Object.fromEntries(taken), time, frame });
    return { width, height, params, moves,
      view: moved(reflection, this.camera, width, height, this.#isParallel) };
  }

  /// Draws at once, coarsely if it must be, and finely when changes stop.
  #change() {
    if (!this.clock.isPlaying) this.redraw(true);
    clearTimeout(this.#resting);
    this.#resting = setTimeout(() => this.clock.isPlaying || this.redraw(false), REST);
  }

  #play(on) {
    const was = this.clock.isPlaying;
    this.clock.play(on);
    const { play } = this.#elements;
    play.textContent = on ? "Pause" : "Play";
    play.setAttribute("aria-pressed", String(on));
    if (was && !on) this.#change();
  }

  #showTime() {
    const { time } = this.#elements;
    if (document.activeElement !== time) time.value = this.clock.time.toFixed(2);
  }

  stopClock(time) {
    this.clock.set(time);
    this.#play(false);
    this.#showTime();
  }

  /// Forgets camera, params and time, for another scene.
  reset({ values = {}, camera = {}, time = 0 } = {}) {
    for (const name of Object.keys(this.values)) delete this.values[name];
    Object.assign(this.values, values);
    Object.assign(this.camera, still(), camera);
    this.clock.set(time);
    this.#elements.form.replaceChildren();
  }
}
