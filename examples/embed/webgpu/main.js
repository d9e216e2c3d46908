// Draws the scene in scene.wgsl on the canvas, with a knob for each of its params. Where it uses `time` it moves.

import { clock, compiled, knobs } from "../reflection.js";
import { openDevice, picture } from "./picture.js";

async function main() {
  const [text, reflection] = await compiled("scene.wgsl");
  const canvas = document.querySelector("canvas");
  const { setParams } = await picture(await openDevice(), canvas, text, reflection);
  knobs(reflection, document.querySelector("form"), setParams);
  clock(reflection, setParams);
}

main().then(
  () => (document.body.dataset.state = "drawn"),
  (error) => {
    document.body.dataset.state = "failed";
    document.querySelector("p").textContent = error.message;
  },
);
