// Builds the page into `target/playground`, and measures it. Run it with `npm run build`.

import { cp, mkdir, readFile, readdir, rm, stat, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, gzipSync } from "node:zlib";
import { build } from "esbuild";
import { findScenes } from "./scenes.js";

const here = fileURLToPath(new URL(".", import.meta.url));
const [src, root] = [join(here, "src"), join(here, "..")];
const dist = join(root, "target/playground");
/// Returns the functions and shapes of the library, with their documentation.
async function library() {
  const folder = join(root, "crates/lang/std");
  const found = new Map();
  for (const file of (await readdir(folder)).sort()) {
    const text = await readFile(join(folder, file), "utf8");
    const declarations = text.matchAll(
      /((?:^\/\/\/.*\n)*)^(?:fn|solid|region|shape)\s+([a-z]\w*)(\((?:[^()]|\([^()]*\))*\))/gm);
    for (const [, doc, name, signature] of declarations) {
      const plain = doc.replace(/^\/\/\/ ?/gm, "").trim();
      if (!found.has(name)) found.set(name, { name, signature: signature.replace(/\s+/g, " "), doc: plain });
    }
  }
  return [...found.values()];
}

/// A module of the bundle that is made here.
const virtual = (name, make) => ({
  name,
  setup(build) {
    build.onResolve({ filter: new RegExp(`^${name}$`) }, () => ({ path: name, namespace: name }));
    build.onLoad({ filter: /.*/, namespace: name }, async () => ({ contents: await make(), loader: "json" }));
  },
});

async function bundle(options) {
  const standard = { bundle: true, minify: true, format: "esm", target: "es2022", legalComments: "none", logLevel: "warning" };
  return build({ ...standard, ...options });
}

const started = performance.now();
await rm(dist, { recursive: true, force: true });
const sections = await findScenes(root);
const list = sections.map(({ title, scenes }) => ({ title, scenes: scenes.map(({ name, title, image }) => ({ name, title, image })) }));
const plugins = [
  virtual("examples", () => JSON.stringify(list)),
  virtual("library", async () => JSON.stringify(await library())),
];
// The editor is a file of its own, so that the workers start before it is loaded.
await bundle({
  entryPoints: [join(src, "main.js")], outdir: dist, splitting: true, chunkNames: "[name]", plugins,
});
const entries = ["compiler.worker.js", "draw.worker.js", "style.css"];
await bundle({
  entryPoints: entries.map((name) => join(src, name)),
  outdir: dist,
  // The package for Node.js reads files; a browser never reaches that line.
  external: ["node:fs/promises"],
});

const worker = await bundle({ entryPoints: [join(src, "draw.worker.js")], format: "iife", write: false });
const code = await bundle({
  entryPoints: [join(src, "standalone.js")],
  write: false,
  plugins: [virtual("worker-code", () => JSON.stringify(worker.outputFiles[0].text))],
});
const style = await readFile(join(dist, "style.css"), "utf8");
const page = (await readFile(join(src, "standalone.html"), "utf8"))
  .replace("/*STYLE*/", () => style)
  .replace("/*CODE*/", () => code.outputFiles[0].text.replaceAll("</script", "<\\/script"));
await writeFile(join(dist, "standalone.html"), page);
await cp(join(src, "index.html"), join(dist, "index.html"));
await cp(join(root, "crates/web/npm/sdfc.wasm"), join(dist, "sdfc.wasm")).catch(() => {
  throw new Error("there is no crates/web/npm/sdfc.wasm: run crates/web/npm/build.sh first");
});
for (const { name, source, picture, image } of sections.flatMap(({ scenes }) => scenes)) {
  const path = join(dist, "examples", name);
  await mkdir(dirname(path), { recursive: true });
  await writeFile(path, source);
  await cp(join(root, picture), join(dist, "examples", image));
}

const size = (bytes) => `${(bytes / 1024).toFixed(0).padStart(6)} KiB`;
// Brotli takes many seconds for the compiler.
const brotli = process.argv.includes("--brotli");
console.log("file".padEnd(22), "      size      gzip", brotli ? "   brotli" : "");
for (const name of (await readdir(dist)).sort()) {
  if (!(await stat(join(dist, name))).isFile()) continue;
  const bytes = await readFile(join(dist, name));
  const packed = [gzipSync(bytes, { level: 9 }), ...(brotli ? [brotliCompressSync(bytes)] : [])];
  console.log(name.padEnd(22), ...[bytes, ...packed].map(({ length }) => size(length)));
}
console.log(`built in ${Math.round(performance.now() - started)} ms`);
