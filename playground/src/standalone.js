// The script of an exported page: one scene, without the compiler.

import workerCode from "worker-code";
import { Stage } from "./stage.js";

const find = (id) => document.getElementById(id);
// The page holds the scene.
const scene = globalThis.SCENE;
const makeWorker = () =>
  new Worker(URL.createObjectURL(new Blob([workerCode], { type: "text/javascript" })));
const say = (text) => (find("status").textContent = text);
const elements = { canvas: find("picture"), form: find("params"), bar: find("clock"),
  play: find("play"), time: find("time") };
const stage = new Stage(elements, {
  opened({ target }) {
    const { text, reflection } = scene.shaders[target.target];
    stage.show(scene.source, text, reflection, !matchMedia("(prefers-reduced-motion)").matches);
  },
  progress: () => {},
  drawn: () => (document.body.dataset.state = "drawn"),
  built: () => say(""),
  refused: ({ reason }) => say(`The browser refused the shader: ${reason}`),
  lost: ({ reason }) => say(`The GPU was lost: ${reason}`),
}, makeWorker);
stage.reset(scene);
stage.picture.start();
