// Draws a frame in horizontal strips, whose height follows the speed of the GPU, so that no strip
// takes long. A slow frame is drawn coarse first.

import { memberPlaces } from "../../examples/embed/reflection.js";

/// The time that one strip, and a frame of a moving picture, should take, in milliseconds.
const STRIP = 40;
/// A frame that is expected to take longer than this is shown while it is drawn.
const SMOOTH = 120;
/// How much coarser the first picture of a slow frame is, and the coarsest moving picture.
const COARSE = 8;
/// The pixels of the first strip of a program, whose speed is not known.
const FIRST = 512;
/// The most by which a strip may have more pixels than the one before.
const GROWTH = 8;

/// Draws frames of one program. `post(tiles, width, height)` receives parts of the picture.
export function painter(program, reflection, post) {
  const place = memberPlaces(reflection, "view");
  // Pixels of the next strip, and pixels per millisecond.
  let pixels = FIRST;
  let speed = 0;

  /// Draws `frame`. A slow frame that does not move ends early if `isStale` returns true, and a
  /// frame that moves is drawn as coarse as it must be. Returns true if the whole frame was drawn.
  return async function paint(frame, isStale) {
    program.setParams(frame.params);
    const { width, height } = frame;
    const expected = () => (speed === 0 ? Infinity : (width * height) / speed);
    const divided = (by) => [width, height].map((side) => Math.max(1, Math.ceil(side / by)));
    if (frame.moves && speed !== 0) {
      const by = Math.min(COARSE, Math.max(1, Math.sqrt(expected() / STRIP)));
      return level(frame, divided(by < 1.3 ? 1 : by), () => false);
    }
    if (expected() > SMOOTH) {
      const small = divided(COARSE);
      const coarse = [];
      await level(frame, small, () => false, coarse);
      // A fast program is not shown coarse: that would only flicker.
      if (expected() > SMOOTH) post(coarse, ...small, 0);
      else coarse.forEach(({ bitmap }) => bitmap.close());
      if (expected() > SMOOTH && isStale()) return false;
    }
    return level(frame, [width, height], expected() > SMOOTH ? isStale : () => false);
  };

  /// Draws all strips of a picture. They are posted, or added to `kept`.
  async function level(frame, [width, height], isStale, kept = null) {
    const view = scaled(frame.view, frame.width, width, height);
    let waiting = kept ?? [];
    let shown = performance.now();
    for (let y = 0; y < height; ) {
      const rows = Math.min(height - y, Math.max(1, Math.floor(pixels / width)));
      new Uint32Array(view).set([0, program.origin(y, rows, height)], place.tile_origin);
      const started = performance.now();
      waiting.push({ bitmap: await program.tile(view, width, rows), y });
      const took = Math.max(0.2, performance.now() - started);
      speed = (rows * width) / took;
      pixels = Math.min(speed * STRIP, GROWTH * rows * width);
      y += rows;
      if (kept === null && (y === height || performance.now() - shown > SMOOTH)) {
        post(waiting, width, height, y / height);
        waiting = [];
        shown = performance.now();
      }
      if (y < height && isStale()) return false;
    }
    return true;
  }

  /// Returns the view buffer for a picture with other numbers of pixels.
  function scaled(view, from, width, height) {
    const bytes = view.slice(0);
    new Float32Array(bytes)[place.pixel_radius] *= from / width;
    new Uint32Array(bytes).set([width, height], place.size);
    return bytes;
  }
}
