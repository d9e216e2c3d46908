// The compiler of sdfc in a page or in node: `const compiler = await load()`, then `compiler.compile(source, options)`.

/// Reads the compiler, from beside this file unless told otherwise: an address, or the bytes.
export async function load(wasm = new URL("sdfc.wasm", import.meta.url)) {
  return new Compiler(await WebAssembly.compile(await bytesOf(wasm)));
}

async function bytesOf(wasm) {
  if (wasm instanceof ArrayBuffer || ArrayBuffer.isView(wasm)) return wasm;
  const url = new URL(wasm, import.meta.url);
  if (url.protocol === "file:") return (await import("node:fs/promises")).readFile(url);
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  return response.arrayBuffer();
}

class Compiler {
  #module;
  #exports;

  constructor(module) {
    this.#module = module;
    this.#begin();
  }

  #begin() {
    this.#exports = new WebAssembly.Instance(this.#module).exports;
  }

  /// Shader, reflection and diagnostics of a scene; see index.d.ts.
  compile(source, options = {}) {
    try {
      return this.#ask(source, JSON.stringify(options));
    } catch (error) {
      // Browsers give WebAssembly a stack of their own measure, which deep nesting can exhaust. What is left of the
      // instance is not used again.
      this.#begin();
      const place = { file: "", line: 0, column: 0, end_line: 0, end_column: 0 };
      const message = `the compiler ended early: ${error.message}`;
      const help = "nest less deeply";
      const found = { code: null, severity: "error", message, ...place, help };
      return { text: null, words: null, reflection: null, diagnostics: [found] };
    }
  }

  #ask(source, options) {
    const { memory, reserve, compile, answer_length } = this.#exports;
    const [scene, rest] = [source, options].map((text) => new TextEncoder().encode(text));
    // Memory may move whenever the compiler runs: it is looked up anew after each call.
    const place = reserve(scene.length + rest.length);
    const room = new Uint8Array(memory.buffer, place, scene.length + rest.length);
    room.set(scene);
    room.set(rest, scene.length);
    const answer = compile(scene.length);
    const bytes = new Uint8Array(memory.buffer, answer, answer_length());
    return JSON.parse(new TextDecoder().decode(bytes));
  }
}
