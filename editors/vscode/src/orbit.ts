// A camera that orbits around its target. The horizon stays level.

export type Vector = [number, number, number];

/** A camera as `sdfc/preview` takes and returns it: with `fov` in degrees, or `height`. */
export interface Camera {
  eye: Vector;
  target: Vector;
  up: Vector;
  fov?: number;
  height?: number;
}

/** The smallest angle between the line of sight and `up`, in radians. */
const MIN_POLE_ANGLE = 0.01;
/** The smallest and the greatest distance of the eye from the target, in scene units. */
const DISTANCES = [1e-6, 1e9] as const;

const add = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const scale = (a: Vector, by: number): Vector => [a[0] * by, a[1] * by, a[2] * by];
const subtract = (a: Vector, b: Vector): Vector => add(a, scale(b, -1));
const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const length = (a: Vector): number => Math.hypot(...a);
const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
const clamp = (x: number, low: number, high: number): number => Math.min(Math.max(x, low), high);

function unit(a: Vector): Vector {
  const size = length(a);
  return size > 0 ? scale(a, 1 / size) : [0, 0, 1];
}

/** Any unit vector at a right angle to `a`. */
function across(a: Vector): Vector {
  return unit(cross(a, Math.abs(a[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
}

/** The directions to the right and upward in the picture, for a unit vector toward the eye. */
function screen(toEye: Vector, up: Vector): [Vector, Vector] {
  const side = cross(up, toEye);
  const right = length(side) > 1e-9 ? unit(side) : across(toEye);
  return [right, cross(toEye, right)];
}

/** Turns the camera around its target by a drag, in parts of the picture's height. */
export function orbit(camera: Camera, dx: number, dy: number): Camera {
  const up = unit(camera.up);
  const toEye = subtract(camera.eye, camera.target);
  const distance = length(toEye);
  const pole = Math.acos(clamp(dot(unit(toEye), up), -1, 1));
  const [right] = screen(unit(toEye), up);
  // A basis around `up`: `ahead` is the level part of the direction to the eye.
  const ahead = cross(right, up);
  const turn = -dx * Math.PI;
  const tilt = clamp(pole - dy * Math.PI, MIN_POLE_ANGLE, Math.PI - MIN_POLE_ANGLE);
  const level = add(scale(ahead, Math.cos(turn)), scale(right, Math.sin(turn)));
  const direction = add(scale(level, Math.sin(tilt)), scale(up, Math.cos(tilt)));
  return { ...camera, eye: add(camera.target, scale(direction, distance)) };
}

/** Moves the camera sideways by a drag, so that the target follows the pointer. */
export function pan(camera: Camera, dx: number, dy: number): Camera {
  const toEye = subtract(camera.eye, camera.target);
  const [right, up] = screen(unit(toEye), unit(camera.up));
  const height = camera.height ?? 2 * length(toEye) * Math.tan(((camera.fov ?? 40) * Math.PI) / 360);
  const by = add(scale(right, -dx * height), scale(up, dy * height));
  return { ...camera, eye: add(camera.eye, by), target: add(camera.target, by) };
}

/** Moves the eye nearer or farther by a factor; parallel rays show less or more instead. */
export function zoom(camera: Camera, factor: number): Camera {
  if (camera.height !== undefined) {
    return { ...camera, height: clamp(camera.height * factor, ...DISTANCES) };
  }
  const toEye = subtract(camera.eye, camera.target);
  const distance = clamp(length(toEye) * factor, ...DISTANCES);
  return { ...camera, eye: add(camera.target, scale(unit(toEye), distance)) };
}
