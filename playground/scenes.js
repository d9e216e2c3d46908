// The scenes of the repository that the playground and the site show, with their pictures.

import { readFile, readdir } from "node:fs/promises";
import { join } from "node:path";

/// The page of the gallery. Its scenes come first.
const GALLERY = "docs/gallery.md";
/// The folders of examples, in the order in which they are shown.
const FOLDERS = [
  ["More scenes", "gallery"], ["One idea each", "."], ["First steps", "course"], ["Camera, light, settings", "settings"],
];

const collator = new Intl.Collator("en");

/// Returns the sections: `title` and `scenes`. A scene has `name`, its path among the examples of
/// the playground; `title`; `source`; `picture`, a file of the repository.
export async function findScenes(root) {
  const folders = await Promise.all(FOLDERS.map(async ([title, folder]) => ({ title, scenes: await exampleScenes(root, folder) })));
  const examples = new Map(folders.flatMap(({ scenes }) => scenes).map((scene) => [body(scene.source), scene]));
  // The gallery shows some examples too. These keep their names, and are listed once.
  const gallery = galleryScenes(await readFile(join(root, GALLERY), "utf8"))
    .map((scene) => ({ ...scene, ...examples.get(body(scene.source)), title: scene.title }));
  const shown = new Set(gallery.map(({ name }) => name));
  const others = folders.map(({ title, scenes }) => ({ title, scenes: scenes.filter(({ name }) => !shown.has(name)) }));
  return [{ title: "Gallery", scenes: gallery }, ...others];
}

/// Returns the scenes of the gallery: under each heading a block of source and its picture.
export function galleryScenes(text) {
  const parts = text.replaceAll("\r\n", "\n").split(/^## /m).slice(1);
  return parts.flatMap((part) => {
    const source = part.match(/^```sdf.*\n([^]*?)^```/m)?.[1];
    const picture = part.match(/^!\[[^\]]*\]\(gallery\/([\w-]+)\.png\)/m)?.[1];
    if (!source || !picture) return [];
    const title = part.slice(0, part.indexOf("\n"));
    return [{ name: `page/${picture}.sdf`, title, source, picture: `docs/gallery/${picture}.png` }];
  });
}

async function exampleScenes(root, folder) {
  const files = await readdir(join(root, "examples", folder));
  const names = files.filter((name) => name.endsWith(".sdf")).sort(collator.compare);
  return Promise.all(names.map(async (file) => {
    const name = folder === "." ? file : `${folder}/${file}`;
    const source = await readFile(join(root, "examples", name), "utf8");
    const title = file.replace(/\.sdf$/, "").replaceAll("_", " ");
    return { name, title: title[0].toUpperCase() + title.slice(1), source, picture: `examples/${name.replace(/sdf$/, "png")}` };
  }));
}

// The gallery leaves out the comment at the top of a file.
const body = (source) => source.replace(/^\s*\/\/.*$/gm, "").replace(/\s+/g, " ").trim();
