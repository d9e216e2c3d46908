// Draws the scene in scene.glsl, which `sdfc compile --emit render --target glsl-es` wrote, on a canvas.

import { paramBytes, knobs, turn, viewBytes } from "../reflection.js";

// One triangle that covers the canvas.
const VERTEX = `#version 300 es
void main() {
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}`;

// The shader gives linear light. A WebGL canvas takes numbers as they are, so they are encoded behind it, in a
// second `main` that calls the first.
function encoded(text) {
  const output = text.match(/ out vec4 (\w+);/)[1];
  return `${text.replace("void main()", "void draw_linear()")}
void main() {
    draw_linear();
    vec3 light = clamp(${output}.rgb, 0.0, 1.0);
    vec3 curve = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
    ${output} = vec4(mix(curve, 12.92 * light, lessThanEqual(light, vec3(0.0031308))), 1.0);
}`;
}

async function main() {
  const [text, reflection] = await Promise.all([
    fetch("scene.glsl").then((response) => response.text()),
    fetch("scene.json").then((response) => response.json()),
  ]);
  const canvas = document.querySelector("canvas");
  const gl = canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: true });
  if (!gl) throw new Error("this browser has no WebGL 2 here");

  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, encoded(text)]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    const logs = gl.getAttachedShaders(program).map((shader) => gl.getShaderInfoLog(shader));
    throw new Error([...logs, gl.getProgramInfoLog(program)].join("\n"));
  }
  gl.useProgram(program);

  // The reflection lists every uniform block that the shader reads. WebGL knows them by their names.
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
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // A param is a few bytes of a uniform: nothing is compiled again.
  knobs(reflection, document.querySelector("form"), (values) => {
    contents.params = paramBytes(reflection, values);
    fill("params");
    requestAnimationFrame(draw);
  });
  canvas.onpointermove = ({ buttons, movementX }) => {
    if (buttons === 0) return;
    turn(reflection, contents.view, -movementX / 100);
    fill("view");
    requestAnimationFrame(draw);
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
