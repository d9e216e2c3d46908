// Compiles scenes, away from the page, so that typing never waits.

import { load } from "../../crates/web/npm/index.js";

const ready = load(new URL("sdfc.wasm", self.location.href));

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
