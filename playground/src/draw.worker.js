// Draws scenes, away from the page, so that neither a long shader nor a slow picture stops it.

import * as webgl2 from "./webgl2.js";
import * as webgpu from "./webgpu.js";
import { painter } from "./tiles.js";

let backend;
let program = null;
let paint = null;
/// The scene of the program. Frames of a scene that was refused are not drawn by an older program.
let shown = null;
let asked = null;
let works = false;

/// Messages: `open` chooses a backend, `scene` replaces the program, `frame` draws.
onmessage = ({ data }) => {
  if (data.type === "open") {
    backend = choose(data.only);
  } else {
    // Of the messages that wait, only the last scene and the last frame count.
    asked = { ...asked, [data.type]: data };
    if (!works) work();
  }
};

async function choose(only) {
  const lost = (reason) => postMessage({ type: "lost", reason });
  const failures = [];
  for (const kind of [webgpu, webgl2]) {
    if (only && only !== kind.id) continue;
    try {
      const opened = await kind.open(lost);
      postMessage({ type: "opened", name: opened.name, target: kind.target });
      return opened;
    } catch (error) {
      failures.push(error.message);
    }
  }
  postMessage({ type: "unavailable", reason: failures.join("; ") });
  return null;
}

async function work() {
  works = true;
  while (asked) {
    const { scene, frame } = asked;
    asked = null;
    try {
      if (scene) await replace(scene);
      if (frame && frame.id === shown) await draw(frame);
    } catch (error) {
      postMessage({ type: "refused", id: (scene ?? frame).id, reason: error.message });
    }
  }
  works = false;
}

async function replace({ id, text, reflection }) {
  const opened = await backend;
  if (!opened) return;
  const started = performance.now();
  const built = await opened.build(text, reflection);
  program?.free();
  program = built;
  shown = id;
  paint = painter(program, reflection, (tiles, width, height, part = 0) => {
    const bitmaps = tiles.map(({ bitmap }) => bitmap);
    postMessage({ type: "tiles", tiles, width, height, part }, bitmaps);
  });
  postMessage({ type: "built", id, milliseconds: performance.now() - started });
}

async function draw(frame) {
  const started = performance.now();
  const isWhole = await paint(frame, () => asked !== null);
  const { id, turn, moves } = frame;
  postMessage({ type: "done", id, turn, moves, isWhole, milliseconds: performance.now() - started });
}
