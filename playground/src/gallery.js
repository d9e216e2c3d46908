// The examples of the repository, with their pictures.

// The bundler makes this list from the gallery and the folder `examples`.
import examples from "examples";

/// The scene that a first visitor sees.
export const FIRST = "params.sdf";

export async function source(name) {
  const response = await fetch(`examples/${name}`);
  if (!response.ok) throw new Error(`no example ${name}: ${response.status}`);
  return response.text();
}

/// Fills the gallery. `chosen` receives the name of an example.
export function fillGallery(parent, chosen) {
  for (const { title, scenes } of examples) {
    const head = document.createElement("h3");
    head.textContent = title;
    const grid = document.createElement("div");
    grid.append(...scenes.map((scene) => tile(scene, chosen)));
    parent.append(head, grid);
  }
}

function tile({ name, title, image }, chosen) {
  const button = document.createElement("button");
  const picture = Object.assign(new Image(), {
    loading: "lazy", alt: "", src: `examples/${image}`,
  });
  button.append(picture, title);
  button.addEventListener("click", () => chosen(name));
  return button;
}
