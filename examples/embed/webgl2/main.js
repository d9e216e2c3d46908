// Draws the scene in scene.glsl, which `sdfc compile --emit render --target glsl-es` wrote, on a
// canvas. If the scene uses `time`, it moves.

import { clock, compiled, sliders, paramBytes, turn, viewBytes } from "../reflection.js";
import { encoded } from "./encoded.js";
import { fullScreen } from "./program.js";

async function main() {
  const [text, reflection] = await compiled("scene.glsl");
  const canvas = document.querySelector("canvas");
  const gl = canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: true });
  if (!gl) throw new Error("this browser has no WebGL 2 here");

  const program = fullScreen(gl, encoded(text));
  gl.useProgram(program);

  // The reflection lists every uniform block that the shader reads. WebGL knows them by their
  // names.
  const contents = {
    view: viewBytes(reflection, canvas.width, canvas.height),
    params: paramBytes(reflection),
  };
  const buffers = {};
  for (const [place, { role, block }] of reflection.buffers.entries()) {
    buffers[role] = gl.createBuffer();
    gl.bindBufferBase(gl.UNIFORM_BUFFER, place, buffers[role]);
    gl.uniformBlockBinding(program, gl.getUniformBlockIndex(program, block), place);
    fill(role);
  }

  function fill(role) {
    gl.bindBuffer(gl.UNIFORM_BUFFER, buffers[role]);
    gl.bufferData(gl.UNIFORM_BUFFER, contents[role], gl.DYNAMIC_DRAW);
  }

  function draw() {
    waits = false;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // Draws once for all changes before the next frame of the screen.
  let waits = false;
  function redraw() {
    if (!waits) requestAnimationFrame(draw);
    waits = true;
  }

  // A param is a few bytes of a uniform buffer. Changing one compiles nothing.
  const values = {};
  function setParams(some) {
    contents.params = paramBytes(reflection, Object.assign(values, some));
    fill("params");
    redraw();
  }
  sliders(reflection, document.querySelector("form"), setParams);
  clock(reflection, setParams);
  canvas.onpointermove = ({ buttons, movementX }) => {
    if (buttons === 0) return;
    turn(reflection, contents.view, -movementX / 100);
    fill("view");
    redraw();
  };
  draw();
  const error = gl.getError();
  if (error !== gl.NO_ERROR) throw new Error(`WebGL error ${error}`);
}

main().then(
  () => (document.body.dataset.state = "drawn"),
  (error) => {
    document.body.dataset.state = "failed";
    document.querySelector("p").textContent = error.message;
  },
);
