// A page that draws one scene and needs no other file.

/// The options of the compiler for the shaders of the page, one for each backend.
export const SHADERS = [
  { target: "wgsl", emit: "render", stage: "fragment" },
  { target: "glsl-es", emit: "render" },
];

/// Returns the page. `code` is the file `standalone.html`, `compiled` has the results of
/// [`SHADERS`], and `state` the source, and optionally the values of params, camera and time.
export function standalonePage(code, compiled, state) {
  const failed = compiled.find(({ text }) => text === null);
  if (failed) throw new Error(failed.diagnostics[0].message);
  const shaders = compiled.map(({ text, reflection }, at) => [SHADERS[at].target, { text, reflection }]);
  const data = JSON.stringify({ shaders: Object.fromEntries(shaders), ...state });
  return code.replace("/*SCENE*/", () => `SCENE = ${data.replaceAll("<", "\\u003c")}`);
}
