// Draws the scene in scene.wgsl on the canvas, with a slider for each of its params. If the scene
// uses `time`, it moves.

import { clock, compiled, sliders } from "../reflection.js";
import { openDevice, picture } from "./picture.js";

async function main() {
  const [text, reflection] = await compiled("scene.wgsl");
  const canvas = document.querySelector("canvas");
  const { setParams } = await picture(await openDevice(), canvas, text, reflection);
  sliders(reflection, document.querySelector("form"), setParams);
  clock(reflection, setParams);
}

main().then(
  () => (document.body.dataset.state = "drawn"),
  (error) => {
    document.body.dataset.state = "failed";
    document.querySelector("p").textContent = error.message;
  },
);
