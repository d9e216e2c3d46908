// The page's side of the compiler: a worker that can be ended and started again.

/// The longest wait for a compilation, in milliseconds. After it the worker is ended. The compiler
/// tries some rays of a scene without a known Lipschitz constant, which can take half a minute.
const MAX_WAIT = 120_000;

export class CompilerClient {
  #worker = null;
  #waiting = new Map();
  #last = 0;

  constructor() {
    this.#start();
  }

  #start() {
    this.#worker = new Worker(new URL("compiler.worker.js", import.meta.url), { type: "module" });
    this.#worker.onmessage = ({ data }) => this.#settle(data.id, data);
    this.#worker.onerror = (event) => this.#restart(`the compiler did not start: ${event.message}`);
  }

  #settle(id, answer) {
    const waiting = this.#waiting.get(id);
    if (!waiting) return;
    clearTimeout(waiting.timer);
    this.#waiting.delete(id);
    if (answer.failure) waiting.reject(new Error(answer.failure));
    else waiting.resolve(answer);
  }

  #restart(failure) {
    this.#worker.terminate();
    for (const id of [...this.#waiting.keys()]) this.#settle(id, { failure });
    this.#start();
  }

  /// Ends all compilations, with an error.
  cancel() {
    if (this.#waiting.size > 0) this.#restart("the compilation was ended");
  }

  /// Compiles a scene; see crates/web/npm/index.d.ts.
  compile(source, options) {
    const id = ++this.#last;
    return new Promise((resolve, reject) => {
      const late = () => this.#restart(`the compiler took more than ${MAX_WAIT / 1000} s`);
      this.#waiting.set(id, { resolve, reject, timer: setTimeout(late, MAX_WAIT) });
      this.#worker.postMessage({ id, source, options });
    });
  }
}
