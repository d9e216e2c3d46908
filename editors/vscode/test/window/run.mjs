// The packaged extension in VS Code itself, by hand: errors, a fix, completion, a rename in two
// files, formatting, and the preview with orbit and sliders. VS Code runs in a browser, as the npm
// package code-server has it. CI does not run this: the installation takes minutes.
//
//   npm install --no-save --ignore-scripts code-server@4.99.4 puppeteer-core
//   (build the native modules of code-server as its postinstall.sh does)
//   npm run package
//   node test/window/run.mjs [folder for screenshots]
//
// Variables: CODE_SERVER, the entry.js of code-server; CHROMIUM; SDFC, the program.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { fileURLToPath } from "node:url";
import puppeteer from "puppeteer-core";
import { sdfc } from "../client.mjs";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const server = process.env.CODE_SERVER ?? here("../../node_modules/code-server/out/node/entry.js");
const pictures = process.argv[2];
const PORT = 8157;
const PATIENCE = 60_000;

const folder = await mkdtemp(`${tmpdir()}/sdf-window-`);
const [scenes, data, extensions] = ["scenes", "data", "extensions"].map((it) => `${folder}/${it}`);
await mkdir(`${data}/User`, { recursive: true });
await mkdir(scenes);
await writeFile(`${data}/User/settings.json`, JSON.stringify({
  "sdf.path": sdfc,
  "files.autoSave": "afterDelay",
  "files.autoSaveDelay": 200,
  "security.workspace.trust.enabled": false,
  "workbench.startupEditor": "none",
  "workbench.colorTheme": "Default Light Modern",
}));
await writeFile(`${scenes}/part.sdf`, `/// A ball with a dent.
solid dented(r: length = 1, dent: length = 0.3)
  bounds -r..r
  = max(length(p) - r, dent - length(p - [r, 0, 0]))
`);
await writeFile(`${scenes}/scene.sdf`, `import dented from "part.sdf"

param r = 0.8 in 0.2..1.5
param tilt = 20deg in 0deg..90deg
param wood = #d94f30
param lid = true
param style = "smooth" in ["smooth", "flat"]

dented(r).color(wood).rotate(z: tilt)
  | bx(0.5).translate(x: 1.4)
plane(y: -0.9).color(#7a8b99)
`);
const home = { ...process.env, HOME: folder };
const options = ["--extensions-dir", extensions, "--user-data-dir", data];
execFileSync("node", [server, ...options, "--install-extension", here("../../sdf.vsix")], { env: home });
const code = spawn(
  "node",
  [server, ...options, "--auth", "none", "--bind-addr", `127.0.0.1:${PORT}`, "--disable-telemetry",
    "--disable-update-check", scenes],
  { env: home, stdio: "ignore" },
);
const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox"],
  defaultViewport: { width: 1400, height: 900 },
});
const page = await browser.newPage();
const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

async function until(what, is) {
  const end = Date.now() + PATIENCE;
  for (;;) {
    const found = await Promise.resolve().then(is).catch(() => undefined);
    if (found) return found;
    assert.ok(Date.now() < end, `${what}: not within ${PATIENCE} ms`);
    await pause(100);
  }
}

const onDisk = (name) => readFile(`${scenes}/${name}`, "utf8");

async function shot(name) {
  if (pictures) await page.screenshot({ path: `${pictures}/${name}.png` });
  console.log(`ok: ${name}`);
}

async function command(name) {
  await page.keyboard.press("F1");
  await until("the list of commands", () => page.$(".quick-input-widget input"));
  await pause(300);
  await page.keyboard.type(name);
  await pause(800);
  await page.keyboard.press("Enter");
  await pause(500);
}

/** Puts the cursor at a line and a column, from 1. */
async function go(line, column) {
  await page.keyboard.down("Control");
  await page.keyboard.press("g");
  await page.keyboard.up("Control");
  await pause(500);
  await page.keyboard.type(`${line}:${column}`);
  await pause(300);
  await page.keyboard.press("Enter");
  await pause(300);
}

try {
  const start = () => page.goto(`http://127.0.0.1:${PORT}/?folder=${scenes}`, { timeout: 5000 });
  await until("the server of VS Code", () => start().then(() => true));
  const row = await until("the file", () => page.$('.explorer-folders-view [aria-label^="scene.sdf"]'));
  await row.click({ count: 2 });
  await until("a squiggle", () => page.$(".squiggly-error"));
  await pause(1500);
  await shot("1-error");

  await go(10, 6);
  await command("Quick Fix...");
  await until("the list of fixes", () => page.$(".action-widget"));
  await pause(500);
  await shot("2-fix");
  await page.keyboard.press("Enter");
  await until("the fix", async () => (await onDisk("scene.sdf")).includes("| box(0.5)"));

  await go(10, 40);
  await page.keyboard.type(".tw");
  await until("completion", async () => {
    const list = await page.$(".suggest-widget.visible");
    return (await list?.evaluate((it) => it.textContent))?.includes("twist") ?? false;
  });
  await pause(800);
  await shot("3-completion");
  await page.keyboard.press("Escape");
  for (let i = 0; i < 3; i++) await page.keyboard.press("Backspace");

  await go(9, 3);
  await page.keyboard.press("F2");
  await until("the field of a rename", () => page.$(".rename-box input"));
  await pause(500);
  await page.keyboard.type("bitten");
  await page.keyboard.press("Enter");
  await until("the rename in this file", async () => (await onDisk("scene.sdf")).includes("bitten(r)"));
  await command("File: Save All");
  await until("the rename in the other", async () => (await onDisk("part.sdf")).includes("solid bitten("));
  await shot("4-rename");

  await go(11, 1);
  await page.keyboard.type("sphere( 0.1 )\n");
  await command("sdfc: Format");
  await until("the format", async () => (await onDisk("scene.sdf")).includes("\nsphere(0.1)\n"));

  await command("sdfc: Show Preview to the Side");
  const frame = await until("the page of the preview", async () => {
    for (const it of page.frames()) if (await it.$("#picture").catch(() => null)) return it;
  });
  const source = () => frame.$eval("#picture", (it) => it.src);
  const status = () => frame.$eval("#status", (it) => it.textContent);
  await until("a picture", source);
  // The sliders make the picture smaller; then it is drawn again.
  await pause(2000);
  const first = await source();
  await shot("5-preview");
  assert.equal((await frame.$$("label")).length, 5);

  const changes = async (what, act) => {
    const before = await source();
    await act();
    await until(what, async () => (await source()) !== before);
    await pause(1000);
  };
  await changes("a picture for the slider", () => frame.$eval("input[type=range]", (it) => {
    it.value = "1.4";
    it.dispatchEvent(new Event("input"));
  }));
  await shot("6-slider");
  const box = await (await frame.$("#stage")).boundingBox();
  await changes("a picture for the drag", async () => {
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 120, box.y + box.height / 2 + 60, { steps: 20 });
    await page.mouse.up();
  });
  await shot("7-orbit");
  await changes("the first picture again", async () => {
    await (await frame.$("#reset")).click();
    await (await frame.$("#home")).click();
    await until("the defaults", async () => (await source()) === first);
  }).catch((error) => assert.fail(error));

  const editor = await page.$(".monaco-editor .view-lines");
  await editor.click();
  await go(11, 1);
  await page.keyboard.type("spher");
  await until("the problem", async () => /the scene has errors/.test(await status()));
  assert.equal(await source(), first, "the picture stays");
  await pause(800);
  await shot("8-problem");
  console.log("all is well");
} catch (error) {
  await page.screenshot({ path: `${pictures ?? tmpdir()}/failed.png` });
  throw error;
} finally {
  await browser.close();
  code.kill();
  await rm(folder, { recursive: true, force: true, maxRetries: 3 }).catch(() => {});
}
