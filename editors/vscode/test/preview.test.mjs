// The preview of the extension against a real `sdfc lsp`: what it asks, when, and what it shows.

import assert from "node:assert/strict";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { after, test } from "node:test";
import { build } from "esbuild";
import { Client, sdfc } from "./client.mjs";

const folder = await mkdtemp(`${tmpdir()}/sdf-preview-`);
await build({
  entryPoints: ["session", "orbit", "fault"].map((it) => new URL(`../src/${it}.ts`, import.meta.url).pathname),
  outdir: folder,
  outExtension: { ".js": ".mjs" },
  platform: "node",
  format: "esm",
  logLevel: "error",
});
const { Session } = await import(`${folder}/session.mjs`);
const { orbit, pan, zoom } = await import(`${folder}/orbit.mjs`);
const { fault } = await import(`${folder}/fault.mjs`);
const client = await Client.start(folder);
after(async () => {
  assert.equal(await client.end(), 0);
  await rm(folder, { recursive: true });
});

/** A page that records what it is told. */
class Page {
  listed = [];
  pictures = [];
  problems = [];
  asked = [];
  uri = `file://${folder}/${Math.random()}.sdf`;
  session = new Session(
    this.uri,
    (method, params, signal) => {
      this.asked.push({ method, size: params.size });
      return client.ask(method, params, signal);
    },
    {
      params: (params, values) => this.listed.push({ params, values: { ...values } }),
      picture: (picture) => this.pictures.push(picture),
      problem: (message) => this.problems.push(message),
    },
    () => 10,
  );

  constructor(text) {
    client.open(this.uri, text);
  }

  async until(is) {
    const end = Date.now() + 60_000;
    while (!is()) {
      assert.ok(Date.now() < end, JSON.stringify([this.asked, this.problems]));
      await new Promise((resolve) => setTimeout(resolve, 5));
    }
  }
}

test("a page gets params and a picture, and follows sliders, camera and text", async () => {
  const page = new Page("param r = 0.5 in 0.1..2\nsphere(r)\n");
  await page.session.resize(48, 32);
  assert.deepEqual(page.listed[0].params.map((it) => it.name), ["r"]);
  const first = page.pictures.at(-1);
  assert.equal(Buffer.from(first.png, "base64").subarray(1, 4).toString(), "PNG");
  await page.session.set("r", 1.5);
  assert.notEqual(page.pictures.at(-1).png, first.png);
  assert.deepEqual(page.pictures.at(-1).camera, first.camera);
  await page.session.look(orbit(first.camera, 0.2, 0.1));
  assert.deepEqual(page.pictures.at(-1).camera.target, first.camera.target);
  await page.session.reset();
  await page.session.look(undefined);
  assert.equal(page.pictures.at(-1).png, first.png);

  // An error in the text is told, and the picture stays until the text is right again.
  const before = page.pictures.length;
  client.change(page.uri, "sphere(\n");
  page.session.changed();
  await page.until(() => page.problems.length > 0);
  assert.match(page.problems[0], /^the scene has errors: /);
  assert.equal(page.pictures.length, before);
  client.change(page.uri, "param r = 3 in 2..4\nparam lid = true\nsphere(r)\n");
  page.session.changed();
  await page.until(() => page.pictures.length > before);
  assert.deepEqual(page.listed.at(-1).params.map((it) => it.name), ["r", "lid"]);
});

test("a value that an edit makes invalid is dropped", async () => {
  const page = new Page("param r = 0.5 in 0.1..2\nsphere(r)\n");
  await page.session.resize(16, 16);
  await page.session.set("r", 1.5);
  client.change(page.uri, "param r = 0.5 in 0.1..1\nsphere(r)\n");
  const before = page.pictures.length;
  page.session.changed();
  await page.until(() => page.pictures.length > before);
  assert.deepEqual([page.listed.at(-1).values, page.problems], [{}, []]);
});

test("a slider that is dragged asks for one picture at a time, then for the last in full", async () => {
  const page = new Page("param r = 0.5 in 0.1..2\nsphere(r)\n");
  await page.session.resize(400, 300);
  page.asked.length = 0;
  let done;
  for (let i = 0; i < 50; i++) done = page.session.set("r", 0.5 + i / 100);
  await done;
  assert.ok(page.asked.length <= 3, JSON.stringify(page.asked));
  await page.until(() => page.asked.at(-1).size[0] === 400);
});

test("typing ends a picture that takes long", async () => {
  const many = "union(for i in 0..12: for j in 0..12: gyroid(0.3).translate([i, j, 0]) & box(9))\n";
  const page = new Page(many);
  const long = page.session.resize(2048, 2048);
  await page.until(() => page.asked.some((it) => it.method === "sdfc/preview"));
  client.change(page.uri, "sphere(1)\n");
  page.session.changed();
  await long;
  await page.until(() => page.pictures.length > 0);
  page.session.dispose();
  assert.deepEqual(page.problems, []);
});

const camera = { eye: [0, 0, 4], target: [0, 0, 0], up: [0, 1, 0], fov: 40 };
const distance = ({ eye, target }) => Math.hypot(...eye.map((it, i) => it - target[i]));

test("orbit keeps the distance and never reaches the pole", () => {
  let moved = camera;
  for (let i = 0; i < 40; i++) {
    moved = orbit(moved, 0.1, 0.2);
    assert.ok(Math.abs(distance(moved) - 4) < 1e-9);
  }
  assert.ok(moved.eye[1] > 3.99 && moved.eye[1] < 4, `${moved.eye}`);
  // A drag to the right shows the left side.
  assert.ok(orbit(camera, 0.1, 0).eye[0] < 0);
  // A drag down shows the top.
  assert.ok(orbit(camera, 0, 0.1).eye[1] > 0);
});

test("pan moves the target by what the pointer moved, zoom changes distance or height", () => {
  const height = 8 * Math.tan(Math.PI / 9);
  const moved = pan(camera, 0.5, 0);
  assert.ok(Math.abs(moved.target[0] + height / 2) < 1e-9, `${moved.target}`);
  assert.equal(distance(moved), 4);
  assert.equal(distance(zoom(camera, 0.5)), 2);
  const parallel = { ...camera, fov: undefined, height: 2 };
  assert.deepEqual([zoom(parallel, 0.5).height, distance(zoom(parallel, 0.5))], [1, 4]);
});

test("a program that is missing or another one is told apart from sdfc", async () => {
  assert.equal(await fault(sdfc), undefined);
  assert.equal(await fault("no-such-program"), "there is no such program");
  assert.equal(await fault("node"), "another program has this name");
});
