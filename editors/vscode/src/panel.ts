// The page of a preview: a picture, sliders, and orbit by dragging.

import type { FromPage, ToPage } from "./messages";
import { type Camera, orbit, pan, zoom } from "./orbit";
import type { Param, Value } from "./session";

declare function acquireVsCodeApi(): { postMessage(message: FromPage): void };

const host = acquireVsCodeApi();
const element = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const picture = element<HTMLImageElement>("picture");
const stage = element<HTMLDivElement>("stage");
const status = element<HTMLDivElement>("status");
const controls = element<HTMLDivElement>("controls");

let camera: Camera | undefined;
/** The camera was moved by hand. Then pictures do not replace it. */
let held = false;

function size(): { width: number; height: number } {
  const box = stage.getBoundingClientRect();
  const dots = window.devicePixelRatio;
  return { width: Math.round(box.width * dots), height: Math.round(box.height * dots) };
}

window.addEventListener("message", (event: MessageEvent<ToPage>) => {
  const message = event.data;
  switch (message.kind) {
    case "params":
      show(message.params, message.values);
      break;
    case "picture": {
      const { png, device, notes } = message.picture;
      picture.src = `data:image/png;base64,${png}`;
      if (!held) camera = message.picture.camera;
      status.className = "";
      status.textContent = [device, ...notes].join("; ");
      break;
    }
    case "problem":
      status.className = "problem";
      status.textContent = message.message;
      break;
  }
});

function move(next: Camera): void {
  camera = next;
  held = true;
  host.postMessage({ kind: "look", camera: next });
}

stage.addEventListener("pointerdown", (event) => {
  stage.setPointerCapture(event.pointerId);
});
stage.addEventListener("pointermove", (event) => {
  if (!camera || !stage.hasPointerCapture(event.pointerId)) return;
  const height = stage.getBoundingClientRect().height;
  const by = [event.movementX / height, event.movementY / height] as const;
  const pans = event.shiftKey || (event.buttons & 6) !== 0;
  move(pans ? pan(camera, ...by) : orbit(camera, ...by));
});
stage.addEventListener("wheel", (event) => {
  event.preventDefault();
  if (camera) move(zoom(camera, Math.exp(event.deltaY * 0.001)));
});
stage.addEventListener("keydown", (event) => {
  if (!camera) return;
  const turns: Record<string, readonly [number, number]> = {
    ArrowLeft: [-0.05, 0],
    ArrowRight: [0.05, 0],
    ArrowUp: [0, -0.05],
    ArrowDown: [0, 0.05],
  };
  const turn = turns[event.key];
  if (turn) move(orbit(camera, ...turn));
  else if (event.key === "+") move(zoom(camera, 0.9));
  else if (event.key === "-") move(zoom(camera, 1 / 0.9));
  else return;
  event.preventDefault();
});
stage.addEventListener("contextmenu", (event) => event.preventDefault());
stage.addEventListener("dblclick", home);
element("home").addEventListener("click", home);
element("reset").addEventListener("click", () => host.postMessage({ kind: "reset" }));

function home(): void {
  held = false;
  host.postMessage({ kind: "look", camera: null });
}

function show(params: Param[], values: Record<string, Value>): void {
  controls.replaceChildren(...params.map((param) => row(param, values[param.name] ?? param.default)));
  element("reset").hidden = params.length === 0;
}

function row(param: Param, value: Value): HTMLElement {
  const label = document.createElement("label");
  const name = document.createElement("span");
  name.textContent = param.name;
  label.append(name, ...inputs(param, value));
  return label;
}

function inputs(param: Param, value: Value): HTMLElement[] {
  const set = (next: Value) => host.postMessage({ kind: "set", name: param.name, value: next });
  if (param.kind === "choice") {
    const select = document.createElement("select");
    select.append(...param.choices.map((choice) => new Option(choice, choice)));
    select.value = String(value);
    select.addEventListener("change", () => set(select.value));
    return [select];
  }
  const input = document.createElement("input");
  if (param.kind === "bool") {
    input.type = "checkbox";
    input.checked = value === true;
    input.addEventListener("change", () => set(input.checked));
    return [input];
  }
  if (param.kind === "color") {
    input.type = "color";
    // The picker has no alpha: the text keeps it.
    const [rgb, alpha] = [String(value).slice(0, 7), String(value).slice(7)];
    input.value = rgb;
    input.addEventListener("input", () => set(input.value + alpha));
    return [input];
  }
  return number(param, Number(value), set);
}

/** A field for the number and, with a range, a slider. */
function number(param: Param, value: number, set: (value: number) => void): HTMLElement[] {
  const field = document.createElement("input");
  field.type = "number";
  field.value = String(value);
  field.step = param.kind === "int" ? "1" : "any";
  if (param.min !== null) field.min = String(param.min);
  if (param.max !== null) field.max = String(param.max);
  const unit = document.createElement("small");
  unit.textContent = param.kind === "angle" ? "°" : "";
  const { min, max } = param;
  if (min === null || max === null) {
    field.addEventListener("change", () => field.checkValidity() && set(field.valueAsNumber));
    return [field, unit];
  }
  const slider = document.createElement("input");
  slider.type = "range";
  [slider.min, slider.max] = [String(min), String(max)];
  // Short decimal numbers: of 0.2..1.5, those with three digits behind the point.
  const digits = param.kind === "int" ? 0 : Math.max(0, Math.ceil(Math.log10(200 / (max - min))));
  slider.step = "any";
  slider.value = String(value);
  slider.addEventListener("input", () => {
    const rounded = Number(slider.valueAsNumber.toFixed(Math.min(digits, 12)));
    // Rounding must not leave the range.
    const next = Math.min(Math.max(rounded, min), max);
    field.value = String(next);
    set(next);
  });
  field.addEventListener("change", () => {
    if (!field.checkValidity()) return;
    slider.value = field.value;
    set(field.valueAsNumber);
  });
  return [slider, field, unit];
}

new ResizeObserver(() => host.postMessage({ kind: "size", ...size() })).observe(stage);
host.postMessage({ kind: "ready", ...size() });
