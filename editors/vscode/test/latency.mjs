// How long `sdfc lsp` takes for previews, and for completion while a preview is drawn. By hand:
//
//   node test/latency.mjs [example...]

import { readFile } from "node:fs/promises";
import { Client, root } from "./client.mjs";

const examples = process.argv.length > 2 ? process.argv.slice(2) : ["course/blend", "params", "gallery/blends"];
const client = await Client.start(root);

/** Repeats a request; p50 and p99 in milliseconds. */
async function times(count, request) {
  const list = [];
  for (let i = 0; i < count; i++) {
    const start = performance.now();
    await request(i);
    list.push(performance.now() - start);
  }
  list.sort((a, b) => a - b);
  const part = (p) => list[Math.min(count - 1, Math.floor(p * count))].toFixed(0);
  return `p50 ${part(0.5)} ms, p99 ${part(0.99)} ms`;
}

for (const name of examples) {
  const uri = `file://${root}/examples/${name}.sdf`;
  const text = await readFile(`${root}/examples/${name}.sdf`, "utf8");
  client.open(uri, text);
  const preview = (size) => client.ask("sdfc/preview", { textDocument: { uri }, size });
  console.log(`${name}, first picture: ${await times(1, () => preview([640, 360]))}`);
  console.log(`${name}, 640 by 360: ${await times(30, () => preview([640, 360]))}`);
  console.log(`${name}, 160 by 90: ${await times(30, () => preview([160, 90]))}`);
  const edited = await times(20, (i) => {
    client.change(uri, text + "\n".repeat(i + 1));
    return preview([640, 360]);
  });
  console.log(`${name}, after an edit: ${edited}`);
}

const uri = `file://${root}/unsaved.sdf`;
const large = "union(for i in 0..12: for j in 0..12: gyroid(0.3).translate([i, j, 0]) & box(9))\n";
client.open(uri, `${large}sphere(1)\n`);
const complete = () => client.ask("textDocument/completion", {
  textDocument: { uri },
  position: { line: 1, character: 4 },
});
console.log(`completion: ${await times(100, complete)}`);
const abort = new AbortController();
let drawing = true;
client.ask("sdfc/preview", { textDocument: { uri }, size: [2048, 2048] }, abort.signal)
  .catch(() => {}).finally(() => (drawing = false));
console.log(`completion while a picture is drawn: ${await times(100, complete)}; still drawn: ${drawing}`);
abort.abort();
await client.end();
