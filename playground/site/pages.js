// The pages of the site: all of `docs`, and those at the top of the repository.

import { readFile, readdir } from "node:fs/promises";
import { join } from "node:path";

/// The pages outside `docs`, and their addresses.
const TOP = { "README.md": "about.html", "CONTRIBUTING.md": "contributing.html", "CHANGELOG.md": "changelog.html", "SECURITY.md": "security.html" };
/// The list of all pages, which becomes the navigation.
export const CONTENTS = "docs/README.md";

/// Returns the pages in alphabetical order: `path` in the repository, `url` on the site, `text`.
export async function findPages(root) {
  const names = await readdir(join(root, "docs"), { recursive: true });
  const docs = names.map((name) => `docs/${name.replaceAll("\\", "/")}`).filter((name) => name.endsWith(".md"));
  const all = [...Object.keys(TOP), ...docs.sort()];
  return Promise.all(all.map(async (path) => {
    const text = await readFile(join(root, path), "utf8");
    return { path, url: urlOf(path), text: text.replaceAll("\r\n", "\n"), opens: 0 };
  }));
}

function urlOf(path) {
  if (TOP[path]) return TOP[path];
  if (path === CONTENTS) return "contents.html";
  return path.replace(/^docs\//, "").replace(/README\.md$/, "index.md").replace(/\.md$/, ".html");
}
