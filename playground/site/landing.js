// The first page: what sdfc is, a scene that runs in the page, pictures, and where to go next.

import { escape, frame } from "./page.js";

/// The pictures of the first page, in this order.
const SHELF = ["page/watch.sdf", "page/reef.sdf", "page/night_city.sdf", "page/tea.sdf", "page/mandelbulb.sdf", "page/synthesizer.sdf", "page/bridge.sdf", "page/poster.sdf"];

const RESULTS = [
  ["targets.html", "Shaders", "WGSL, GLSL, HLSL, Metal, SPIR-V and Shadertoy, with every param as a uniform."],
  ["meshes.html", "Meshes", "Closed, with sharp edges and a proven error, as STL, 3MF, GLB, OBJ or PLY."],
  ["contours.html", "Outlines", "The section by a plane as SVG or DXF, for a laser cutter or a drawing."],
  ["measurements.html", "Measurements", "Volume, center of mass and clearance, as intervals that hold the truth."],
  ["farm.html", "Animations", "PNG, EXR and GIF, on one machine or in parts on a render farm."],
  ["embedding.html", "Your program", "Rust, C, Python or JavaScript; wgpu, three.js, Bevy or a shader of your own."],
];

const NEXT = [
  ["tutorial.html", "Tutorial", "From one ball to a moving lighthouse in half an hour."],
  ["cookbook.html", "Cookbook", "Bolt circles, letters, textures, animations: short recipes."],
  ["coming-from.html", "Coming from other tools", "What you know from GLSL, OpenSCAD, Curv, Bauble or Fidget, here."],
  ["reference/index.html", "Reference", "Every shape, operator, function and setting, with a picture."],
];

const card = ([url, title, text]) => `<a class="card" href="${url}"><h3>${title}</h3><p>${text}</p></a>`;

/// A picture that opens its scene in the playground.
export const tile = ({ name, title, image }) =>
  `<a class="tile" href="playground/index.html?example=${name}"><img src="playground/examples/${image}" alt="" loading="lazy" width="640" height="400"><span>${escape(title)}</span></a>`;

/// `hero` has `code`, the coloured source of the scene that runs in the page, and `open`, its
/// address in the playground. `sections` are those of [`findScenes`].
export function landing(hero, sections, site) {
  const all = sections.flatMap(({ scenes }) => scenes);
  const shelf = SHELF.map((name) => {
    const found = all.find((scene) => scene.name === name);
    if (!found) throw new Error(`the first page shows ${name}, which is no scene of the playground`);
    return found;
  });
  const { repository } = site;
  const body = `<main id="content" class="landing">
<section class="hero">
  <div class="words">
    <h1>Write a shape.<br>Get a shader.</h1>
    <p class="lead">sdfc is a small language for solids and pictures made of signed distance functions. It
      compiles a scene to one shader that contains the operations of that scene and nothing else.</p>
    <p class="actions"><a class="button" href="playground/index.html">Open the playground</a>
      <a class="button quiet" href="tutorial.html">Take the tutorial</a></p>
    <p class="hint">The playground compiles and draws in your browser. There is nothing to install.</p>
  </div>
  <figure class="live">
    <div class="stage"><img src="hero.png" alt="A round lantern throws the pattern of its holes on the floor and the wall" width="960" height="720"><iframe data-src="hero.html" title="The scene, drawn in this page"></iframe></div>
    <div class="scene"><pre><code>${hero.code}</code></pre><a class="open" href="${hero.open}">Edit this scene</a></div>
  </figure>
</section>
<section>
  <h2>Scenes</h2>
  <p class="lead">Each is one file of at most a hundred lines. Choose one to see its source and change it.</p>
  <div class="tiles">${shelf.map((scene) => tile(scene)).join("\n")}</div>
  <p><a href="gallery.html">All ${all.length} scenes</a></p>
</section>
<section>
  <h2>One scene, many results</h2>
  <div class="cards">${RESULTS.map(card).join("\n")}</div>
</section>
<section class="split">
  <div>
    <h2>Fast and exact, and measured</h2>
    <p>The compiler derives how steep each shape's distance is. Where it can prove that, a ray takes the longest
      safe step, and intersects simple parts without any step. Where it cannot, the ray is proven piece by piece,
      or the picture says which pixels are not.</p>
    <p>Every ray method is measured on the same scenes: how much it computes, and how far its pictures are
      off. The lower left corner is the best.</p>
    <p><a href="accuracy.html">How accurate it is</a> · <a href="stability.html">Where methods fail</a> ·
      <a href="benchmarks.html">How fast it is</a></p>
  </div>
  <img src="charts/snowman.svg" alt="Operations per pixel against the error in depth, for each ray method" loading="lazy">
</section>
<section class="split">
  <img src="viewer/editor.png" alt="The viewer: a scene, its source and its sliders" loading="lazy">
  <div>
    <h2>A picture that follows the text</h2>
    <p>The viewer redraws while you type, with a slider for every param and handles on the shapes. The language
      server completes names, explains shapes, and fixes mistakes in your own editor.</p>
    <p><a href="viewer.html">The viewer</a> · <a href="editors.html">VS Code and other editors</a></p>
  </div>
</section>
<section>
  <h2>Install</h2>
  <div class="cards rows">
    <div class="card"><h3>Linux and macOS</h3><pre><code>curl -sSfL ${repository}/releases/latest/download/install.sh | sh</code></pre>
      <p>The script checks the download, needs no root, and installs into <code>~/.local</code>. Archives for
        Windows, and a package for Debian, are <a href="${repository}/releases">beside it</a>.</p></div>
    <div class="card"><h3>From source</h3><pre><code>cargo install --locked --git ${repository} sdfc-cli sdfc-viewer</code></pre>
      <p>Needs <a href="https://rustup.rs">Rust</a> 1.95 or newer. There are packages for <a href="python.html">Python</a>
        and for <a href="embedding-web.html">web pages</a> too.</p></div>
  </div>
</section>
<section>
  <h2>Next</h2>
  <div class="cards four">${NEXT.map(card).join("\n")}</div>
</section>
</main>`;
  return frame("index.html", "sdfc: shapes from distance functions, compiled to shaders", body, site);
}
