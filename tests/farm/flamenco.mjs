// Tests packaging/farm/flamenco/sdfc.js: compiles jobs as Flamenco Manager does, runs their
// commands in an order that the dependencies allow, and compares the files with those that one
// process draws.
//
//   SDFC=target/debug/sdfc node --test tests/farm/flamenco.mjs

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import test from "node:test";
import vm from "node:vm";

const here = import.meta.dirname ?? new URL(".", import.meta.url).pathname;
const script = join(here, "../../packaging/farm/flamenco/sdfc.js");
const scene = join(here, "scene.sdf");
const sdfc = resolve(process.env.SDFC ?? "target/debug/sdfc");

// What Flamenco Manager offers to scripts, as its page "Job Types" documents it.
function compiled(settings) {
  const tasks = [];
  const author = {
    Command: (name, parameters) => ({ name, parameters }),
    Task: (name, type) => ({
      name,
      type,
      commands: [],
      dependencies: [],
      addCommand(command) { this.commands.push(command); },
      addDependency(task) { this.dependencies.push(task); },
    }),
  };
  const context = vm.createContext({ author, frameChunker: chunks });
  vm.runInContext(readFileSync(script, "utf8"), context, { filename: script });
  const defaults = {};
  for (const { key, default: value } of vm.runInContext("JOB_TYPE", context).settings) {
    defaults[key] = value;
  }
  const job = { settings: { ...defaults, ...settings }, addTask: (task) => tasks.push(task) };
  context.job = job;
  vm.runInContext("compileJob(job)", context);
  return tasks;
}

// Cuts frames such as "3, 5-10" into chunks of a size: frames in a row become a range.
function chunks(frames, size) {
  const all = frames.split(",").flatMap((range) => {
    const [first, last = first] = range.split("-").map(Number);
    return Array.from({ length: last - first + 1 }, (_, index) => first + index);
  });
  const result = [];
  for (let start = 0; start < all.length; start += size) {
    const ranges = [];
    for (const frame of all.slice(start, start + size)) {
      const range = ranges.at(-1);
      if (range && range[1] === frame - 1) range[1] = frame;
      else ranges.push([frame, frame]);
    }
    result.push(ranges.map(([a, b]) => (a === b ? `${a}` : `${a}-${b}`)).join(","));
  }
  return result;
}

// Runs the tasks, the last ones first where dependencies allow that.
function run(tasks) {
  const waiting = [...tasks].reverse();
  const done = new Set();
  while (waiting.length > 0) {
    const next = waiting.findIndex((task) => task.dependencies.every((other) => done.has(other)));
    assert.notEqual(next, -1, "the dependencies are circular");
    const [task] = waiting.splice(next, 1);
    for (const { name, parameters } of task.commands) {
      assert.equal(name, "exec");
      execFileSync(parameters.exe, parameters.args, { stdio: ["ignore", "ignore", "pipe"] });
    }
    done.add(task);
  }
}

for (const [bands, frames, chunkSize] of [[1, "0-23", 5], [3, "2, 5-7", 3]]) {
  test(`frames ${frames} in ${bands} bands are those of one process`, () => {
    const folder = mkdtempSync(join(tmpdir(), "sdfc-"));
    try {
      const size = "64x40";
      const common = { sdfc, scene, size, device: "cpu", frames, chunk_size: chunkSize, bands };
      run(compiled({ ...common, output: join(folder, "frame.png") }));
      const options = ["--size", size, "--backend", "cpu"];
      for (const range of frames.split(",").map((range) => range.trim())) {
        const alone = ["--frames", range, "--output", join(folder, "alone.png")];
        execFileSync(sdfc, ["render", scene, ...alone, ...options], { stdio: "pipe" });
      }
      const alone = readdirSync(folder).filter((name) => name.startsWith("alone"));
      assert.ok(alone.length === (bands === 1 ? 24 : 4));
      for (const name of alone) {
        const frame = readFileSync(join(folder, name.replace("alone", "frame")));
        assert.ok(frame.equals(readFileSync(join(folder, name))), name);
      }
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
}

test("a band of a frame waits for no other band, and the frame for all of them", () => {
  const settings = { scene, output: "/shared/frame.exr", frames: "0-5", chunk_size: 3, bands: 2 };
  const tasks = compiled(settings);
  assert.deepEqual(tasks.map((task) => [task.name, task.dependencies.length]), [
    ["draw 0-2, band 1 of 2", 0], ["draw 0-2, band 2 of 2", 0], ["join 0-2", 2],
    ["draw 3-5, band 1 of 2", 0], ["draw 3-5, band 2 of 2", 0], ["join 3-5", 2],
  ]);
  const last = tasks.at(-1).commands.at(-1).parameters;
  assert.deepEqual([...last.args], ["join", "--output", "/shared/frame.0005.exr"]);
});
