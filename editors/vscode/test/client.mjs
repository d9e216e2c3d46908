// A client of `sdfc lsp` over stdio.

import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("../../..", import.meta.url));
/** The program: that of the variable `SDFC`, or the one that cargo has built. */
export const sdfc = process.env.SDFC ??
  ["release", "debug"].map((it) => `${root}/target/${it}/sdfc`).find(existsSync) ?? "sdfc";
export { root };

export class Client {
  #id = 0;
  #waiting = new Map();
  #rest = Buffer.alloc(0);
  /** Calls `listener` with the method of each notification and its params. */
  listener = () => {};

  static async start(folder) {
    const client = new Client();
    client.child = spawn(sdfc, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
    client.child.stdout.on("data", (data) => client.#receive(data));
    client.child.on("exit", () => {
      for (const { reject } of client.#waiting.values()) reject(new Error("the server ended"));
    });
    client.server = await client.ask("initialize", { capabilities: {}, rootUri: `file://${folder}` });
    client.notify("initialized", {});
    return client;
  }

  /** Sends a request. An aborted signal cancels it. */
  ask(method, params, signal) {
    const id = ++this.#id;
    const answer = new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
    signal?.addEventListener("abort", () => this.notify("$/cancelRequest", { id }));
    this.#send({ jsonrpc: "2.0", id, method, params });
    return answer;
  }

  notify(method, params) {
    this.#send({ jsonrpc: "2.0", method, params });
  }

  open(uri, text, version = 1) {
    this.notify("textDocument/didOpen", { textDocument: { uri, languageId: "sdf", version, text } });
  }

  change(uri, text) {
    this.notify("textDocument/didChange", { textDocument: { uri, version: 2 }, contentChanges: [{ text }] });
  }

  async end() {
    await this.ask("shutdown");
    const ended = new Promise((resolve) => this.child.on("exit", resolve));
    this.notify("exit");
    return ended;
  }

  #send(message) {
    const text = JSON.stringify(message);
    this.child.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
  }

  #receive(data) {
    this.#rest = Buffer.concat([this.#rest, data]);
    for (;;) {
      const head = this.#rest.indexOf("\r\n\r\n");
      if (head < 0) return;
      const length = Number(/Content-Length: (\d+)/.exec(this.#rest.toString("latin1", 0, head))[1]);
      const end = head + 4 + length;
      if (this.#rest.length < end) return;
      const message = JSON.parse(this.#rest.toString("utf8", head + 4, end));
      this.#rest = this.#rest.subarray(end);
      const waiting = this.#waiting.get(message.id);
      if (!waiting) {
        this.listener(message.method, message.params);
        continue;
      }
      this.#waiting.delete(message.id);
      if (message.error) waiting.reject(Object.assign(new Error(message.error.message), message.error));
      else waiting.resolve(message.result);
    }
  }
}
