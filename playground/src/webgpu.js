// Draws tiles of a compiled scene with WebGPU.

export const id = "webgpu";
export const target = { target: "wgsl", emit: "render", stage: "fragment" };

/// Opens a device that draws on a canvas without a place in the page. `lost` is called with a
/// reason if the device is lost.
export async function open(lost) {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) throw new Error("this browser has no WebGPU here");
  const device = await adapter.requestDevice();
  device.lost.then(({ reason, message }) => reason !== "destroyed" && lost(message));
  const canvas = new OffscreenCanvas(16, 16);
  const context = canvas.getContext("webgpu");
  const stored = navigator.gpu.getPreferredCanvasFormat();
  // The shader returns linear light. A view with an sRGB format encodes it for the canvas.
  const format = `${stored}-srgb`;
  context.configure({ device, format: stored, viewFormats: [format], alphaMode: "opaque" });
  const build = (text, reflection) => program({ device, canvas, context, format }, text, reflection);
  return { name: "WebGPU", build };
}

async function program({ device, canvas, context, format }, text, reflection) {
  const module = device.createShaderModule({ code: text });
  const entry = (stage) => reflection.entry_points.find((entry) => entry.stage === stage).name;
  const pipeline = await device.createRenderPipelineAsync({
    layout: "auto",
    vertex: { module, entryPoint: entry("vertex") },
    fragment: { module, entryPoint: entry("fragment"), targets: [{ format }] },
  });
  const buffers = {};
  const entries = reflection.buffers.map(({ role, binding, size }) => {
    const kind = role === "lists" ? GPUBufferUsage.STORAGE : GPUBufferUsage.UNIFORM;
    const bytes = role === "lists" ? 4 * reflection.lists.length : size;
    buffers[role] = device.createBuffer({ size: bytes, usage: kind | GPUBufferUsage.COPY_DST });
    return { binding, resource: { buffer: buffers[role] } };
  });
  if (buffers.lists) device.queue.writeBuffer(buffers.lists, 0, new Float32Array(reflection.lists));
  const group = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries });

  return {
    /// The first row of a tile in the view buffer.
    origin: (y) => y,
    setParams: (bytes) => buffers.params && device.queue.writeBuffer(buffers.params, 0, bytes),
    /// Draws the tile that the view buffer names, and returns it when the GPU is done.
    async tile(view, width, height) {
      if (canvas.width !== width) canvas.width = width;
      if (canvas.height !== height) canvas.height = height;
      device.queue.writeBuffer(buffers.view, 0, view);
      const encoder = device.createCommandEncoder();
      const target = context.getCurrentTexture().createView({ format });
      const pass = encoder.beginRenderPass({
        colorAttachments: [{ view: target, loadOp: "clear", storeOp: "store" }],
      });
      pass.setPipeline(pipeline);
      pass.setBindGroup(0, group);
      pass.draw(3);
      pass.end();
      device.queue.submit([encoder.finish()]);
      const bitmap = canvas.transferToImageBitmap();
      await device.queue.onSubmittedWorkDone();
      return bitmap;
    },
    free: () => Object.values(buffers).forEach((buffer) => buffer.destroy()),
  };
}
