// The page of the gallery shows all scenes of the repository.

import { tile } from "./landing.js";
import { escape } from "./page.js";

/// Makes the pictures of the page open their scenes in the playground, and adds those of all other
/// scenes at its end.
export function addTiles(page, [own, ...others]) {
  const names = new Map(own.scenes.map(({ name, picture }) => [picture.replace("docs/", ""), name]));
  page.content = page.content.replace(/<img [^>]*src="([^"]+)"[^>]*>/g, (image, path) => {
    const name = names.get(path);
    return name ? `<a href="playground/index.html?example=${name}">${image}</a>` : image;
  });
  for (const section of others) {
    const { title, scenes } = section;
    const tiles = `<div class="tiles">${scenes.map((scene) => tile(scene)).join("\n")}</div>\n`;
    page.content += `<h2 id="${anchor(title)}">${escape(title)}</h2>\n${tiles}`;
    page.sections.push({ title, anchor: anchor(title), level: 2, text: [] });
  }
}

const anchor = (title) => `scenes-${title.toLowerCase().replace(/[^a-z]+/g, "-")}`;
