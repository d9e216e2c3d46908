// Links of pages: where they lead on the site, and whether they lead anywhere.

import { existsSync, statSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { join, posix } from "node:path";

/// Files that the site has copies of. All others are on the web page of the repository.
const COPIED = /\.(?:png|svg|jpg|json)$/;

export class Links {
  /// What is wrong, one line for each dead link.
  dead = [];
  /// The files that pages show or link to, as paths in the repository.
  files = new Set();
  count = 0;
  #root;
  #pages;
  #repository;
  /// Links to headings, which are known when all pages were read.
  #anchors = [];

  constructor(root, pages, repository) {
    this.#root = root;
    this.#pages = new Map(pages.map((page) => [page.path, page]));
    this.#repository = repository;
  }

  page(path) {
    return this.#pages.get(path);
  }

  urlOfFile(path) {
    return path.replace(/^docs\//, "");
  }

  /// Returns the address on the site of what a page links to, or shows.
  resolve(page, href, isShown) {
    this.count += 1;
    if (/^[a-z]+:/.test(href)) {
      if (isShown) this.dead.push(`${page.path}: ${href} would be fetched from elsewhere`);
      return href;
    }
    const [rest, anchor] = href.split("#");
    const path = rest === "" ? page.path : posix.join(posix.dirname(page.path), decodeURI(rest));
    const target = this.#pages.get(path) ?? this.#pages.get(posix.join(path, "README.md"));
    if (target) {
      if (anchor !== undefined) this.#anchors.push({ page, href, target, anchor });
      const url = target === page && anchor !== undefined ? "" : relative(page.url, target.url);
      return anchor === undefined ? url : `${url}#${anchor}`;
    }
    const file = join(this.#root, path);
    if (path.startsWith("..") || !existsSync(file)) {
      this.dead.push(`${page.path}: ${href}`);
      return href;
    }
    if (COPIED.test(path)) {
      this.files.add(path);
      return relative(page.url, this.urlOfFile(path));
    }
    const kind = statSync(file).isDirectory() ? "tree" : "blob";
    return `${this.#repository}/${kind}/main/${path}`;
  }

  /// Checks the links to headings.
  check() {
    for (const { page, href, target, anchor } of this.#anchors) {
      if (!target.anchors.has(decodeURIComponent(anchor))) this.dead.push(`${page.path}: ${href}`);
    }
  }
}

/// Returns the address of a file of the site as a page links to it.
export function relative(from, to) {
  return posix.relative(posix.dirname(from), to) || posix.basename(to);
}

/// Returns the addresses in the finished pages of a folder that lead to no file.
export async function missingFiles(folder, urls) {
  const found = await Promise.all(urls.map(async (url) => {
    const text = await readFile(join(folder, url), "utf8");
    const hrefs = [...text.matchAll(/ (?:href|src|data-src)="([^"]*)"/g)].map(([, href]) => href);
    return hrefs.filter((href) => {
      const path = href.split(/[?#]/)[0];
      const isOwn = path !== "" && !/^[a-z]+:/.test(path);
      return isOwn && !existsSync(join(folder, posix.dirname(url), decodeURI(path)));
    }).map((href) => `${url}: ${href}`);
  }));
  return found.flat();
}
