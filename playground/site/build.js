// Builds the site from `docs` into `target/site`, with the playground in it. Fails if a link leads
// nowhere or a page shows something from elsewhere. Run it with `npm run site`.

import { execFileSync } from "node:child_process";
import { cp, mkdir, readFile, rm, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { load } from "../../crates/web/npm/index.js";
import { Links } from "./links.js";
import { reader } from "./markdown.js";
import { html, navigation } from "./page.js";
import { index } from "./search_index.js";
import { findPages } from "./pages.js";

const here = fileURLToPath(new URL(".", import.meta.url));
const root = join(here, "../..");
const dist = join(root, "target/site");

async function write(path, content) {
  await mkdir(dirname(join(dist, path)), { recursive: true });
  await writeFile(join(dist, path), content);
}

const started = performance.now();
await rm(dist, { recursive: true, force: true });
await mkdir(dist, { recursive: true });

const manifest = await readFile(join(root, "Cargo.toml"), "utf8");
const repository = manifest.match(/^repository = "(.*)"$/m)[1];
const pages = await findPages(root);
const links = new Links(root, pages, repository);
const compiler = await load(new URL("../../crates/web/npm/sdfc.wasm", import.meta.url));
const read = reader(links, compiler);
for (const page of pages) await read(page);
links.check();
if (links.dead.length > 0) {
  console.error(`${links.dead.length} links are wrong:\n${links.dead.join("\n")}`);
  process.exit(1);
}

const contents = navigation(pages, links);
for (const page of pages) await write(page.url, html(page, contents));
for (const file of links.files) {
  await mkdir(dirname(join(dist, links.urlOfFile(file))), { recursive: true });
  await cp(join(root, file), join(dist, links.urlOfFile(file)));
}
await write("search.json", index(pages));
await build({
  entryPoints: [join(here, "search.js"), join(here, "site.css")],
  outdir: dist, bundle: true, minify: true, format: "esm", target: "es2022", logLevel: "warning",
});

execFileSync("node", [join(root, "playground/build.js")], { stdio: "ignore" });
await cp(join(root, "target/playground"), join(dist, "playground"), { recursive: true });
const playground = await readFile(join(dist, "playground/index.html"), "utf8");
const heading = '<h1><a href="../index.html">sdfc</a> <span>playground</span></h1>';
const docs = '<a class="site" href="../index.html">Documentation</a>';
await write("playground/index.html", playground.replace(/<h1>.*<\/h1>/, `${heading}\n  ${docs}`));

const count = pages.reduce((sum, { opens }) => sum + opens, 0);
const seconds = ((performance.now() - started) / 1000).toFixed(1);
console.log(`${pages.length} pages, ${links.count} links, ${count} scenes for the playground, ${seconds} s`);
