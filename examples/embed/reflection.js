// Uses the file that `sdfc compile --reflect` writes: fills the buffers, and makes the sliders.

/// Loads the shader and the reflection of a scene, which `sdfc compile` wrote beside the page.
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

/// Returns the content of the view buffer (camera, lights, limits) for a picture of this size.
export function viewBytes(reflection, width, height) {
  if (reflection.view.length === 0) throw new Error("no picture: compile with --emit render");
  const bytes = new Uint32Array(reflection.view).buffer;
  const floats = new Float32Array(bytes);
  const words = new Uint32Array(bytes);
  const place = memberPlaces(reflection, "view");
  const vector = (name) => floats.subarray(place[name], place[name] + 3);

  // `up` is half the height of the picture at distance 1, `right` half its width.
  const [right, up] = [vector("right"), vector("up")];
  const factor = ((Math.hypot(...up) / Math.hypot(...right)) * width) / height;
  right.set(right.map((lane) => lane * factor));
  floats[place.pixel_radius] = Math.hypot(...right) / width;
  words.set([width, height], place.size);
  return bytes;
}

/// Turns the camera of such a buffer about the vertical axis through `middle`, by an angle in
/// radians.
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

/// Returns the content of the params buffer. `values` has, by name, the params that are not at
/// their defaults.
export function paramBytes(reflection, values = {}) {
  const bytes = new ArrayBuffer(reflection.uniform?.size ?? 0);
  for (const { param, type, offset, default: standard } of reflection.params) {
    const lanes = [values[param] ?? standard].flat();
    const Lanes = type === "bool" ? Uint32Array : Float32Array;
    new Lanes(bytes, offset, lanes.length).set(lanes);
  }
  return bytes;
}

// Params that change by themselves.
const CLOCK = ["time", "frame"];

/// Calls `changed` with `time`, in seconds, and `frame` before each frame of the screen, if the
/// scene uses either. `?time=1.5` in the address of the page stops the clock there. Returns a
/// function that ends the clock.
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

/// Adds an input for each param to `parent`. Calls `changed` with the values of params that were
/// changed.
export function sliders(reflection, parent, changed) {
  const values = {};
  for (const row of reflection.params.filter(({ param }) => !CLOCK.includes(param))) {
    const [input, read] = slider(row);
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

/// Returns the element that sets a param, and a function that reads it.
function slider({ type, min, max, choices, default: lanes }) {
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

/// Conversions between linear light and sRGB.
export const encode = (light) =>
  light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055;
export const decode = (code) =>
  code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4;

/// Returns where the members of a buffer's structure are, as indices into arrays of 4-byte words.
export function memberPlaces(reflection, role) {
  const { type } = reflection.buffers.find((buffer) => buffer.role === role);
  const { members } = reflection.structs.find(({ name }) => name === type);
  return Object.fromEntries(members.map(({ name, offset }) => [name, offset / 4]));
}
