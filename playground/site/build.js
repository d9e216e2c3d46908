// Builds the site from `docs` into `target/site`, with the playground in it. Fails if a link leads
// nowhere or a page shows something from elsewhere. Run it with `npm run site`.

import { execFileSync } from "node:child_process";
import { cp, mkdir, readFile, rm, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { load } from "../../crates/web/npm/index.js";
import { GALLERY, findScenes } from "../scenes.js";
import { toFragment } from "../src/link.js";
import { SHADERS, standalonePage } from "../src/standalone_page.js";
import { addTiles } from "./gallery.js";
import { landing } from "./landing.js";
import { Links, missingFiles } from "./links.js";
import { colored, reader } from "./markdown.js";
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

const copy = (from, to) => cp(join(root, from), join(dist, to), { recursive: true });

function fail(wrong) {
  console.error(`${wrong.length} links are wrong:\n${wrong.join("\n")}`);
  process.exit(1);
}

const started = performance.now();
await rm(dist, { recursive: true, force: true });
await mkdir(dist, { recursive: true });

const manifest = await readFile(join(root, "Cargo.toml"), "utf8");
const stated = (key) => manifest.match(new RegExp(`^${key} = "(.*)"$`, "m"))[1];
const site = { version: stated("version"), repository: stated("repository") };
const pages = await findPages(root);
const links = new Links(root, pages, site.repository);
const compiler = await load(new URL("../../crates/web/npm/sdfc.wasm", import.meta.url));
const read = reader(links, compiler);
for (const page of pages) await read(page);
links.check();
if (links.dead.length > 0) fail(links.dead);

const scenes = await findScenes(root);
addTiles(links.page(GALLERY), scenes);
const contents = navigation(pages, links);
for (const page of pages) await write(page.url, html(page, contents, site));
for (const file of links.files) await copy(file, links.urlOfFile(file));
await write("search.json", index(pages));
await build({
  entryPoints: [join(here, "site.js"), join(here, "site.css")],
  outdir: dist, bundle: true, minify: true, format: "esm", target: "es2022", logLevel: "warning",
});

execFileSync("node", [join(root, "playground/build.js")], { stdio: "ignore" });
await copy("target/playground", "playground");
const playground = await readFile(join(dist, "playground/index.html"), "utf8");
await write("playground/index.html", playground.replace(/<h1>.*<\/h1>/, '<h1><a href="../index.html">sdfc</a> <span>playground</span></h1>'));

// The scene that runs in the first page.
const source = await readFile(join(here, "hero.sdf"), "utf8");
const compiled = SHADERS.map((options) => compiler.compile(source, options));
await write("hero.html", standalonePage(await readFile(join(dist, "playground/standalone.html"), "utf8"), compiled, { source }));
await copy("playground/site/hero.png", "hero.png");
const hero = { code: colored(source), open: `playground/index.html${await toFragment({ source })}` };
await write("index.html", landing(hero, scenes, site));

const missing = await missingFiles(dist, ["index.html", ...pages.map(({ url }) => url)]);
if (missing.length > 0) fail(missing);
const count = pages.reduce((sum, { opens }) => sum + opens, 0);
const seconds = ((performance.now() - started) / 1000).toFixed(1);
console.log(`${pages.length + 1} pages, ${links.count} links, ${count} scenes for the playground, ${seconds} s`);
