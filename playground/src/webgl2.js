// Draws tiles of a compiled scene with WebGL 2.

import { fullScreen } from "../../examples/embed/webgl2/program.js";
import { encoded } from "../../examples/embed/webgl2/encoded.js";

export const id = "webgl2";
export const target = { target: "glsl-es", emit: "render" };

/// Opens a context of a canvas without a place in the page. `lost` is called if it is lost.
export async function open(lost) {
  const canvas = new OffscreenCanvas(16, 16);
  const gl = canvas.getContext("webgl2", { antialias: false, depth: false, alpha: false });
  if (!gl) throw new Error("this browser has neither WebGPU nor WebGL 2 here");
  canvas.addEventListener("webglcontextlost", () => lost("the context was lost"));
  return { name: "WebGL 2", build: async (text, reflection) => program(gl, canvas, text, reflection) };
}

function program(gl, canvas, text, reflection) {
  const linked = fullScreen(gl, encoded(text));
  gl.useProgram(linked);
  const buffers = {};
  for (const [place, { role, block }] of reflection.buffers.entries()) {
    buffers[role] = gl.createBuffer();
    gl.bindBufferBase(gl.UNIFORM_BUFFER, place, buffers[role]);
    gl.uniformBlockBinding(linked, gl.getUniformBlockIndex(linked, block), place);
  }
  function fill(role, bytes) {
    gl.bindBuffer(gl.UNIFORM_BUFFER, buffers[role]);
    gl.bufferData(gl.UNIFORM_BUFFER, bytes, gl.DYNAMIC_DRAW);
  }
  return {
    /// The first row of a tile in the view buffer: rows of WebGL count from the bottom.
    origin: (y, height, whole) => whole - y - height,
    setParams: (bytes) => buffers.params && fill("params", bytes),
    async tile(view, width, height) {
      if (canvas.width !== width) canvas.width = width;
      if (canvas.height !== height) canvas.height = height;
      fill("view", view);
      gl.viewport(0, 0, width, height);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
      const bitmap = canvas.transferToImageBitmap();
      await signalled(gl, fence);
      gl.deleteSync(fence);
      return bitmap;
    },
    free() {
      for (const shader of gl.getAttachedShaders(linked)) gl.deleteShader(shader);
      gl.deleteProgram(linked);
      Object.values(buffers).forEach((buffer) => gl.deleteBuffer(buffer));
    },
  };
}

async function signalled(gl, fence) {
  gl.flush();
  for (;;) {
    const state = gl.clientWaitSync(fence, 0, 0);
    if (state !== gl.TIMEOUT_EXPIRED || gl.isContextLost()) return;
    await new Promise((resolve) => setTimeout(resolve, 1));
  }
}
