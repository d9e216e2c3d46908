// The page of the gallery shows all scenes of the repository.

import { tile } from "./landing.js";
import { escape } from "./page.js";

export const GALLERY = "docs/gallery.md";

/// Adds pictures that open their scenes in the playground: those of the page before its first
/// heading, all others at its end.
export function addTiles(page, [own, ...others]) {
  const tiles = ({ scenes }) => `<div class="tiles">${scenes.map((scene) => tile(scene)).join("\n")}</div>\n`;
  page.content = page.content.replace("<h2", () => `${tiles(own)}<h2`);
  for (const section of others) {
    const { title } = section;
    page.content += `<h2 id="${anchor(title)}">${escape(title)}</h2>\n${tiles(section)}`;
    page.sections.push({ title, anchor: anchor(title), level: 2, text: [] });
  }
}

const anchor = (title) => `scenes-${title.toLowerCase().replace(/[^a-z]+/g, "-")}`;
