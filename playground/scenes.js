// The scenes of the repository that the playground and the site show, with their pictures.

import { readFile, readdir } from "node:fs/promises";
import { dirname, extname, join } from "node:path";

/// The page of the gallery. Its scenes come first.
export const GALLERY = "docs/gallery.md";
/// The folders of examples, in the order in which they are shown.
const FOLDERS = [
  ["More scenes", "gallery"], ["One idea each", "."], ["First steps", "course"], ["Camera, light, settings", "settings"],
];

const collator = new Intl.Collator("en");

/// Returns the sections: `title` and `scenes`. A scene has `name`, its path among the examples of
/// the playground; `title`; `source`; `picture`, a file of the repository; `image`, the path of that
/// picture among the examples.
export async function findScenes(root) {
  const folders = await Promise.all(FOLDERS.map(async ([title, folder]) => ({ title, scenes: await exampleScenes(root, folder) })));
  const examples = new Map(folders.flatMap(({ scenes }) => scenes).map((scene) => [body(scene.source), scene]));
  // The gallery shows some examples too. These keep their names, and are listed once.
  const read = (file) => readFile(join(root, file), "utf8");
  const gallery = (await galleryScenes(await read(GALLERY), (file) => read(join(dirname(GALLERY), file))))
    .map((scene) => ({ ...scene, name: examples.get(body(scene.source))?.name ?? scene.name }));
  const shown = new Set(gallery.map(({ name }) => name));
  const others = folders.map(({ title, scenes }) => ({ title, scenes: scenes.filter(({ name }) => !shown.has(name)) }));
  const withImage = ({ title, scenes }) => ({ title, scenes: scenes.map((scene) => ({ ...scene, image: imageOf(scene) })) });
  return [{ title: "Gallery", scenes: gallery }, ...others].map(withImage);
}

const imageOf = ({ name, picture }) => name.replace(/\.sdf$/, extname(picture));

/// Returns the scenes of the gallery in the order of their pictures. The source of a picture is the
/// block before it, which has a heading, or the file of the same name, which `read` returns.
async function galleryScenes(text, read) {
  const found = [];
  const page = text.replaceAll("\r\n", "\n");
  let start = 0;
  for (const match of page.matchAll(/^!\[[^\]]*\]\(gallery\/([\w-]+)\.(\w+)\)/gm)) {
    const [whole, file, extension] = match;
    const block = page.slice(start, match.index).match(/^### (.*)\n[^]*^```sdf\n([^]*?)^```\s*$/m);
    const [title, source] = block ? block.slice(1) : [titled(file), await read(`gallery/${file}.sdf`)];
    start = match.index + whole.length;
    found.push({ name: `page/${file}.sdf`, title, source, picture: `docs/gallery/${file}.${extension}` });
  }
  return found;
}

/// The title of a file: `night_city` is "Night city".
function titled(file) {
  const words = file.replaceAll("_", " ");
  return words[0].toUpperCase() + words.slice(1);
}

async function exampleScenes(root, folder) {
  const files = await readdir(join(root, "examples", folder));
  const names = files.filter((name) => name.endsWith(".sdf")).sort(collator.compare);
  return Promise.all(names.map(async (file) => {
    const name = folder === "." ? file : `${folder}/${file}`;
    const source = await readFile(join(root, "examples", name), "utf8");
    return { name, title: titled(file.replace(/\.sdf$/, "")), source, picture: `examples/${name.replace(/sdf$/, "png")}` };
  }));
}

// The gallery leaves out the comment at the top of a file.
const body = (source) => source.replace(/^\s*\/\/.*$/gm, "").replace(/\s+/g, " ").trim();
