// An input for each param of a scene.

import { decode, encode } from "../../examples/embed/reflection.js";

/// Params that change by themselves.
export const CLOCK = ["time", "frame"];

/// Returns the rows of all params that have an input. Another value of a fixed param compiles the
/// scene again.
export const inputRows = ({ params, fixed_params }) => [
  ...fixed_params.map((row) => ({ ...row, default: row.value, isFixed: true })),
  ...params.filter(({ param }) => !CLOCK.includes(param)),
];

/// Returns the value of a param, one number per lane: that of `values` if the param takes it,
/// otherwise its default. Values come from links, and from older texts of the scene.
export function lanesOf({ param, type, min, max, choices, default: standard }, values) {
  const lanes = [Object.hasOwn(values, param) ? values[param] : standard].flat();
  const [lane] = lanes;
  const takes = {
    int: () => Number.isInteger(lane),
    bool: () => lane === 0 || lane === 1,
    choice: () => choices[lane] !== undefined,
  };
  const fits = lanes.length === standard.length && lanes.every(Number.isFinite)
    && lane >= (min ?? -Infinity) && lane <= (max ?? Infinity) && (takes[type]?.() ?? true);
  return fits ? lanes : standard;
}

/// The functions that show another value, by the element of the param.
const updates = new WeakMap();

/// Replaces the inputs in `parent` by those of some rows. `values` has the params that are not at
/// their defaults; it is changed, and `changed` is called with the row. Inputs of params that stay
/// are kept, so that they keep the focus.
export function showControls(parent, rows, values, changed) {
  const old = new Map([...parent.children].map((child) => [child.dataset.key, child]));
  parent.replaceChildren(...rows.map((row) => {
    // The default of a fixed param is the value that the scene was compiled with.
    const key = JSON.stringify(row.isFixed ? { ...row, value: null, default: null } : row);
    const found = old.get(key) ?? control(key, row, values, changed);
    updates.get(found)(lanesOf(row, values));
    return found;
  }));
  parent.hidden = rows.length === 0;
}

function control(key, row, values, changed) {
  const label = document.createElement("label");
  const name = document.createElement("span");
  const shown = document.createElement("output");
  const { input, read, write, tell } = kinds[row.type]?.(row) ?? number(row);
  input.name = row.param;
  name.textContent = row.param;
  updates.set(label, (lanes) => {
    // The text of a field is not written again while it is typed.
    if (String(read()) !== String(lanes)) write(lanes);
    shown.textContent = tell(lanes);
  });
  input.addEventListener("input", () => {
    values[row.param] = read();
    shown.textContent = tell([values[row.param]].flat());
    changed(row);
  });
  // A double click on the name restores the default.
  name.title = "Double-click to reset";
  name.addEventListener("dblclick", () => {
    delete values[row.param];
    if (!row.isFixed) updates.get(label)(row.default);
    changed(row);
  });
  label.dataset.key = key;
  label.append(name, input, shown);
  return label;
}

const kinds = {
  number, int: number, angle: number,
  bool() {
    const input = Object.assign(document.createElement("input"), { type: "checkbox" });
    const write = ([lane]) => (input.checked = lane !== 0);
    return { input, read: () => Number(input.checked), write, tell: () => "" };
  },
  choice({ choices }) {
    const input = document.createElement("select");
    input.append(...choices.map((name, index) => new Option(name, index)));
    const write = ([lane]) => (input.value = lane);
    return { input, read: () => Number(input.value), write, tell: () => "" };
  },
  color({ default: [, , , alpha] }) {
    const input = Object.assign(document.createElement("input"), { type: "color" });
    const hex = (lanes) => `#${lanes.slice(0, 3)
      .map((lane) => Math.round(255 * encode(Math.min(Math.max(lane, 0), 1))).toString(16).padStart(2, "0"))
      .join("")}`;
    const byte = (place) => parseInt(input.value.slice(place, place + 2), 16);
    const read = () => [...[1, 3, 5].map((place) => decode(byte(place) / 255)), alpha];
    return { input, read, write: (lanes) => (input.value = hex(lanes)), tell: hex };
  },
};

function number({ type, min, max }) {
  const input = document.createElement("input");
  const hasRange = min !== null && max !== null;
  Object.assign(input, { type: hasRange ? "range" : "number", min, max });
  input.step = type === "int" ? 1 : "any";
  const tell = ([lane]) => {
    if (!hasRange) return "";
    return type === "angle" ? `${short((lane * 180) / Math.PI)}°` : short(lane);
  };
  return { input, read: () => Number(input.value), write: ([lane]) => (input.value = lane), tell };
}

const short = (x) => String(Number(x.toPrecision(3)));
