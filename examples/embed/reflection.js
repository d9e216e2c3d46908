// What the files that `sdfc compile --reflect` writes tell a page: what the buffers hold, and which knobs there are.

/// The text and the reflection of a scene, which `sdfc compile` wrote beside the page.
export async function compiled(file, described = "scene.json") {
  const [text, reflection] = await Promise.all(
    [file, described].map(async (name) => {
      const response = await fetch(name);
      if (!response.ok) throw new Error(`no ${name} beside the page: sdfc compile writes it`);
      return response.text();
    }),
  );
  return [text, JSON.parse(reflection)];
}

/// What the buffer of camera, lights and limits holds for a picture of this size.
export function viewBytes(reflection, width, height) {
  if (reflection.view.length === 0) throw new Error("no picture: compile with --emit render");
  const bytes = new Uint32Array(reflection.view).buffer;
  const floats = new Float32Array(bytes);
  const words = new Uint32Array(bytes);
  const place = memberPlaces(reflection, "view");
  const vector = (name) => floats.subarray(place[name], place[name] + 3);

  // `up` is half the picture's height at distance 1. Its half width follows from the new shape.
  const [right, up] = [vector("right"), vector("up")];
  const factor = ((Math.hypot(...up) / Math.hypot(...right)) * width) / height;
  right.set(right.map((lane) => lane * factor));
  floats[place.pixel_radius] = Math.hypot(...right) / width;
  words.set([width, height], place.size);
  return bytes;
}

/// Turns that camera about the vertical axis through `middle`, by an angle in radians.
export function turn(reflection, bytes, angle, middle = [0, 0, 0]) {
  const floats = new Float32Array(bytes);
  const place = memberPlaces(reflection, "view");
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  for (const name of ["eye", "right", "up", "forward"]) {
    const lanes = floats.subarray(place[name], place[name] + 3);
    const [mx, , mz] = name === "eye" ? middle : [0, 0, 0];
    const [x, z] = [lanes[0] - mx, lanes[2] - mz];
    [lanes[0], lanes[2]] = [c * x + s * z + mx, c * z - s * x + mz];
  }
}

/// What the buffer of params holds. `values` has, by name, those that are not at their defaults.
export function paramBytes(reflection, values = {}) {
  const bytes = new ArrayBuffer(reflection.uniform?.size ?? 0);
  for (const { param, type, offset, default: standard } of reflection.params) {
    const lanes = [values[param] ?? standard].flat();
    const Lanes = type === "bool" ? Uint32Array : Float32Array;
    new Lanes(bytes, offset, lanes.length).set(lanes);
  }
  return bytes;
}

// What moves by itself.
const CLOCK = ["time", "frame"];

/// Tells `changed` what `time`, in seconds, and `frame` are, before each picture of the screen, if the scene uses either. The page's
/// address can stop it: `?time=1.5`. Gives what ends it.
export function clock(reflection, changed) {
  if (!reflection.params.some(({ param }) => CLOCK.includes(param))) return () => {};
  const stopped = new URLSearchParams(location.search).get("time");
  if (stopped !== null) {
    changed({ time: Number(stopped), frame: 0 });
    return () => {};
  }
  const start = performance.now();
  let frame = 0;
  let waiting = requestAnimationFrame(tick);
  function tick(now) {
    waiting = requestAnimationFrame(tick);
    changed({ time: Math.max(0, now - start) / 1000, frame: frame++ });
  }
  return () => cancelAnimationFrame(waiting);
}

/// A knob for each param, in `parent`. `changed` is told the values of those that were moved.
export function knobs(reflection, parent, changed) {
  const values = {};
  for (const row of reflection.params.filter(({ param }) => !CLOCK.includes(param))) {
    const [input, read] = knob(row);
    input.name = row.param;
    input.oninput = () => {
      values[row.param] = read();
      changed(values);
    };
    const label = document.createElement("label");
    label.append(row.param, input);
    parent.append(label);
  }
}

/// The element that sets a param, and what reads it.
function knob({ type, min, max, choices, default: lanes }) {
  const input = document.createElement(type === "choice" ? "select" : "input");
  if (type === "choice") {
    input.append(...choices.map((name, index) => new Option(name, index)));
    input.value = lanes[0];
    return [input, () => Number(input.value)];
  } else if (type === "color") {
    const [r, g, b] = lanes.map((lane) => Math.round(255 * encode(lane)));
    input.type = "color";
    input.value = `#${((r << 16) | (g << 8) | b).toString(16).padStart(6, "0")}`;
    const byte = (place) => parseInt(input.value.slice(place, place + 2), 16);
    return [input, () => [...[1, 3, 5].map((place) => decode(byte(place) / 255)), lanes[3]]];
  } else if (type === "bool") {
    Object.assign(input, { type: "checkbox", checked: lanes[0] !== 0 });
    return [input, () => Number(input.checked)];
  }
  const inRange = min !== null && max !== null;
  Object.assign(input, { type: inRange ? "range" : "number", min, max });
  input.step = type === "int" ? 1 : "any";
  input.value = lanes[0];
  return [input, () => Number(input.value)];
}

// Between linear light and the numbers of sRGB.
const encode = (light) => (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055);
const decode = (code) => (code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4);

/// Members of the structure in the buffer of a role, as places in arrays of words of 4 bytes.
function memberPlaces(reflection, role) {
  const { type } = reflection.buffers.find((buffer) => buffer.role === role);
  const { members } = reflection.structs.find(({ name }) => name === type);
  return Object.fromEntries(members.map(({ name, offset }) => [name, offset / 4]));
}
