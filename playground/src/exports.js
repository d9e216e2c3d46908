// Saves the shader, the picture, and a page that needs no other file.

import { SHADERS, standalonePage } from "./standalone_page.js";

const EXTENSIONS = {
  wgsl: "wgsl", glsl: "glsl", "glsl-es": "glsl", hlsl: "hlsl", msl: "metal", spirv: "spv", shadertoy: "glsl",
};
/// The targets of shaders, and the parts of a shader.
export const TARGETS = Object.keys(EXTENSIONS);
export const PARTS = { field: "distance only", march: "with the ray", render: "whole picture" };

/// Compiles the shader that the fields of the dialog name. Returns its text or words.
export async function exported(compiler, { source, values }, { target, emit }) {
  const options = { target, emit, values };
  if (emit === "render" && target !== "shadertoy") options.stage = "fragment";
  const { text, words, diagnostics } = await compiler.compile(source, options);
  if (text === null && words === null) {
    throw new Error(diagnostics.find(({ severity }) => severity === "error")?.message ?? "no shader");
  }
  return { content: text ?? new Uint32Array(words), name: `scene.${EXTENSIONS[target]}` };
}

/// Lets the browser save a file.
export function save(content, name, type = "text/plain") {
  const url = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  Object.assign(document.createElement("a"), { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/// Returns a page that draws the scene, with its inputs, without any other file.
export async function standalone(compiler, state) {
  const { source, values } = state;
  const [code, ...compiled] = await Promise.all([
    fetch("standalone.html").then((response) => response.text()),
    ...SHADERS.map((options) => compiler.compile(source, { ...options, values })),
  ]);
  return standalonePage(code, compiled, state);
}
