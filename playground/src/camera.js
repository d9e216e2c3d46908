// Orbit, pan and zoom: changes the camera of a view buffer.

import { memberPlaces, viewBytes } from "../../examples/embed/reflection.js";

/// Radians per pixel that the pointer moves.
const TURN = 0.008;
/// The largest angle from the horizon.
const STEEPEST = 1.55;

/// The width of what is always in the picture, as a multiple of the height that the camera has.
const NARROWEST = 1.25;

/// A camera that was not moved.
export const still = () => ({ yaw: 0, pitch: 0, zoom: 1, x: 0, y: 0 });

/// Returns the view buffer of a scene for a picture of this size, with its camera moved.
export function moved(reflection, camera, width, height, isParallel) {
  const bytes = viewBytes(reflection, width, height);
  const floats = new Float32Array(bytes);
  const place = memberPlaces(reflection, "view");
  const lanes = (name) => floats.subarray(place[name], place[name] + 3);
  const [eye, right, up, forward] = ["eye", "right", "up", "forward"].map(lanes);

  // In a narrow canvas the sides of the scene would be cut off.
  const narrow = Math.max(1, (NARROWEST * height) / width);
  for (const vector of [right, up]) vector.set([...vector].map((lane) => lane * narrow));
  floats[place.pixel_radius] *= narrow;

  const pivot = pivotOf(reflection, [...eye], normal(forward));
  let arm = sub(eye, pivot);
  const distance = length(arm);
  // Pitch is limited so that the camera does not turn over a pole.
  const [aside, height0] = [normal(right), Math.asin(clamp(-normal(forward)[1], -1, 1))];
  const pitch = clamp(height0 + camera.pitch, -STEEPEST, STEEPEST) - height0;
  const turned = (v) => rotate(rotate(v, aside, -pitch), [0, 1, 0], camera.yaw);
  for (const vector of [right, up, forward]) vector.set(turned([...vector]));
  arm = turned([...arm]).map((lane) => lane * camera.zoom);
  if (isParallel) {
    for (const vector of [right, up]) vector.set([...vector].map((lane) => lane * camera.zoom));
    floats[place.pixel_radius] *= camera.zoom;
  }
  // Pans are in halves of the picture's height at the distance of the pivot.
  const reach = (isParallel ? 1 : distance * camera.zoom) * length(up);
  const [sideways, upwards] = [normal(right), normal(up)];
  eye.set(pivot.map((lane, axis) =>
    lane + arm[axis] + reach * (camera.x * sideways[axis] + camera.y * upwards[axis])));
  return bytes;
}

/// Returns what the camera turns about: the point of its axis that is nearest to the middle of the
/// scene.
function pivotOf({ certificate: { bounds } }, eye, forward) {
  const ends = [bounds?.min ?? [], bounds?.max ?? []];
  const middle = [0, 1, 2].map((axis) => {
    const [low, high] = ends.map((end) => end[axis] ?? null);
    return low === null || high === null ? 0 : (low + high) / 2;
  });
  const t = Math.max(dot(sub(middle, eye), forward), 0.05);
  return eye.map((lane, axis) => lane + t * forward[axis]);
}

/// Moves a camera by pointer, wheel, touch and keys. `changed` is called after each change.
export function control(canvas, camera, changed) {
  const pointers = new Map();
  const change = (some) => {
    Object.assign(camera, some);
    changed();
  };
  const turn = (dx, dy) => change({ yaw: camera.yaw - TURN * dx, pitch: camera.pitch + TURN * dy });
  const pan = (dx, dy) => {
    const half = canvas.clientHeight / 2;
    change({ x: camera.x - dx / half, y: camera.y + dy / half });
  };
  const zoom = (factor) => change({ zoom: clamp(camera.zoom * factor, 0.01, 100) });

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => pointers.delete(event.pointerId));
  }
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    if (pointers.size === 2) pinch(event.pointerId, before, now);
    else if (event.shiftKey || event.buttons & 6) pan(dx, dy);
    else turn(dx, dy);
    pointers.set(event.pointerId, now);
  });
  function pinch(id, before, now) {
    const [other] = [...pointers].filter(([key]) => key !== id).map(([, at]) => at);
    const gap = (at) => Math.max(1, Math.hypot(at[0] - other[0], at[1] - other[1]));
    pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
    zoom(gap(before) / gap(now));
  }
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)));
  }, { passive: false });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, -12], ArrowDown: [0, 12] };
    const keys = {
      "+": () => zoom(0.9), "=": () => zoom(0.9), "-": () => zoom(1 / 0.9), Home: () => change(still()),
    };
    if (step[event.key]) (event.shiftKey ? pan : turn)(...step[event.key]);
    else if (keys[event.key]) keys[event.key]();
    else return;
    event.preventDefault();
  });
}

const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const sub = (a, b) => [0, 1, 2].map((axis) => a[axis] - b[axis]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const length = (v) => Math.hypot(...v);
const normal = (v) => [...v].map((lane) => lane / length(v));

/// Rotates a vector about a unit axis (Rodrigues).
function rotate(v, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const along = dot(axis, v) * (1 - c);
  const cross = [
    axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0],
  ];
  return v.map((lane, k) => c * lane + s * cross[k] + along * axis[k]);
}
