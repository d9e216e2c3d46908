// The compiler of sdfc for web pages and Node.js: `const compiler = await load()`, then
// `compiler.compile(source, options)`.

/// Loads the compiler from a URL or from bytes. Default: `sdfc.wasm` beside this file.
export async function load(wasm = new URL("sdfc.wasm", import.meta.url)) {
  const module = await moduleOf(wasm);
  return new Compiler(module, await WebAssembly.instantiate(module));
}

async function moduleOf(wasm) {
  if (wasm instanceof ArrayBuffer || ArrayBuffer.isView(wasm)) return WebAssembly.compile(wasm);
  const url = new URL(wasm, import.meta.url);
  if (url.protocol === "file:") {
    return WebAssembly.compile(await (await import("node:fs/promises")).readFile(url));
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  // Browsers keep the machine code of what they compile from a stream, which needs this type.
  return response.headers.get("Content-Type") === "application/wasm"
    ? WebAssembly.compileStreaming(response)
    : WebAssembly.compile(await response.arrayBuffer());
}

class Compiler {
  #module;
  #exports;

  constructor(module, instance) {
    this.#module = module;
    this.#exports = instance.exports;
  }

  /// Compiles from now on with another instance. A browser starts a large module at once only in a
  /// worker. In a page the instance is there a little later.
  #restart() {
    this.#exports = null;
    try {
      this.#exports = new WebAssembly.Instance(this.#module).exports;
    } catch {
      WebAssembly.instantiate(this.#module).then(({ exports }) => (this.#exports = exports));
    }
  }

  /// Returns shader, reflection and diagnostics of a scene; see index.d.ts.
  compile(source, options = {}) {
    if (!this.#exports) return failed("the compiler starts again after a failure", "compile again");
    try {
      return this.#call(source, JSON.stringify(options));
    } catch (error) {
      // Browsers limit the stack of WebAssembly, and deep nesting can exhaust it. The instance is then
      // in an unknown state and is not used again.
      this.#restart();
      return failed(`the compiler failed: ${error.message}`, "nest less deeply");
    }
  }

  #call(source, options) {
    const { memory, reserve, compile, answer_length } = this.#exports;
    const [scene, rest] = [source, options].map((text) => new TextEncoder().encode(text));
    // Memory may move whenever the compiler runs, so `memory.buffer` is read again after each call.
    const address = reserve(scene.length + rest.length);
    const input = new Uint8Array(memory.buffer, address, scene.length + rest.length);
    input.set(scene);
    input.set(rest, scene.length);
    const answer = compile(scene.length);
    const bytes = new Uint8Array(memory.buffer, answer, answer_length());
    return JSON.parse(new TextDecoder().decode(bytes));
  }
}

function failed(message, help) {
  const position = { file: "", line: 0, column: 0, end_line: 0, end_column: 0 };
  const diagnostic = { code: null, severity: "error", message, ...position, help, fixes: [] };
  return { text: null, words: null, reflection: null, diagnostics: [diagnostic] };
}
