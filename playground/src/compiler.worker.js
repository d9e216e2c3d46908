// Compiles scenes, away from the page, so that typing never waits.

import { load } from "../../crates/web/npm/index.js";

// The first compilation reads the library. It is done while the page waits for the GPU.
const ready = load(new URL("sdfc.wasm", self.location.href)).then((compiler) => {
  compiler.compile("sphere(1)", { emit: "render", stage: "fragment" });
  return compiler;
});

onmessage = async ({ data: { id, source, options } }) => {
  try {
    const compiler = await ready;
    const started = performance.now();
    const compiled = compiler.compile(source, options);
    postMessage({ id, ...compiled, milliseconds: performance.now() - started });
  } catch (error) {
    postMessage({ id, failure: error.message });
  }
};
