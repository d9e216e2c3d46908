// Draws a compiled scene on a canvas with WebGPU.

import { paramBytes, turn, viewBytes } from "../reflection.js";

/// Opens a GPU device.
export async function openDevice() {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) throw new Error("this browser has no WebGPU here");
  return adapter.requestDevice();
}

/// Prepares the shader that `sdfc compile --emit render --stage fragment` wrote, and draws it.
export async function picture(device, canvas, text, reflection) {
  // The shader returns linear light. A view with an sRGB format encodes it for the canvas.
  const context = canvas.getContext("webgpu");
  const stored = navigator.gpu.getPreferredCanvasFormat();
  const format = `${stored}-srgb`;
  context.configure({ device, format: stored, viewFormats: [format] });

  const module = device.createShaderModule({ code: text });
  const entry = (stage) => {
    const found = reflection.entry_points.find((entry) => entry.stage === stage);
    if (!found) throw new Error(`no ${stage} stage: compile with --emit render --stage fragment`);
    return found.name;
  };
  const pipeline = await device.createRenderPipelineAsync({
    layout: "auto",
    vertex: { module, entryPoint: entry("vertex") },
    fragment: { module, entryPoint: entry("fragment"), targets: [{ format }] },
  });

  // The reflection lists every buffer that the shader reads, and where it is bound.
  const contents = {
    view: viewBytes(reflection, canvas.width, canvas.height),
    params: paramBytes(reflection),
    lists: new Float32Array(reflection.lists).buffer,
  };
  const buffers = {};
  const entries = reflection.buffers.map(({ role, binding }) => {
    const kind = role === "lists" ? GPUBufferUsage.STORAGE : GPUBufferUsage.UNIFORM;
    const size = contents[role].byteLength;
    buffers[role] = device.createBuffer({ size, usage: kind | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(buffers[role], 0, contents[role]);
    return { binding, resource: { buffer: buffers[role] } };
  });
  const group = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries });

  function draw() {
    waits = false;
    const encoder = device.createCommandEncoder();
    const view = context.getCurrentTexture().createView({ format });
    const target = { view, loadOp: "clear", storeOp: "store" };
    const pass = encoder.beginRenderPass({ colorAttachments: [target] });
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, group);
    pass.draw(3);
    pass.end();
    device.queue.submit([encoder.finish()]);
  }

  // A param is a few bytes of a uniform buffer. Changing one compiles nothing. Params that are not
  // named keep their values.
  const values = {};
  function setParams(some) {
    Object.assign(values, some);
    device.queue.writeBuffer(buffers.params, 0, paramBytes(reflection, values));
    redraw();
  }

  // Draws once for all changes before the next frame of the screen.
  let waits = false;
  function redraw() {
    if (!waits) requestAnimationFrame(draw);
    waits = true;
  }

  canvas.onpointermove = ({ buttons: pressed, movementX }) => {
    if (pressed === 0) return;
    turn(reflection, contents.view, -movementX / 100);
    device.queue.writeBuffer(buffers.view, 0, contents.view);
    redraw();
  };
  draw();
  await device.queue.onSubmittedWorkDone();
  return { setParams };
}
