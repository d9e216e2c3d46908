// The frame of a page: head, navigation, search.

import { CONTENTS } from "./pages.js";
import { relative } from "./links.js";

const escape = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");
const ICON = "data:image/svg+xml,<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'><circle cx='4' cy='4' r='3.4' fill='%23d9733f'/></svg>";

/// Returns the parts of the navigation, from the tables of the list of all pages: `title` and
/// `pages`, with `inner` pages of their folders.
export function navigation(pages, links) {
  const text = links.page(CONTENTS).text;
  return text.split(/^## /m).slice(1).map((part) => {
    const title = part.slice(0, part.indexOf("\n"));
    const rows = [...part.matchAll(/^\| \[([^\]]+)\]\(([^)#]+)\)/gm)];
    const found = rows.map(([, name, href]) => {
      const path = new URL(href, `file:///${CONTENTS}`).pathname.slice(1);
      const page = links.page(path);
      return page && { name, page, inner: innerPages(pages, page) };
    });
    return { title, pages: found.filter(Boolean) };
  });
}

/// The pages in the folder of a page: those of the reference, of the tutorial, of the errors.
function innerPages(pages, { path }) {
  const folder = path.endsWith("README.md") ? path.replace(/README\.md$/, "") : path.replace(/\.md$/, "/");
  return pages.filter((page) => page.path !== path && page.path.startsWith(folder));
}

export function html(page, contents) {
  const to = (url) => escape(relative(page.url, url));
  const link = ({ url }, name) =>
    `<a href="${to(url)}"${url === page.url ? ' aria-current="page"' : ""}>${escape(name)}</a>`;
  const item = ({ name, page: shown, inner }) => {
    const isOpen = shown === page || inner.includes(page);
    const list = inner.map((it) => `<li>${link(it, it.title)}</li>`).join("");
    return `<li>${link(shown, name)}${isOpen && list ? `<ul>${list}</ul>` : ""}</li>`;
  };
  const parts = contents.map(({ title, pages }) => `<h2>${escape(title)}</h2><ul>${pages.map(item).join("")}</ul>`);
  const up = relative(page.url, "index.html").replace(/index\.html$/, "");
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>${escape(page.title)}${page.url === "index.html" ? "" : " · sdfc"}</title>
<link rel="icon" href="${ICON}">
<link rel="stylesheet" href="${to("site.css")}">
<body data-root="${up || "./"}">
<a class="skip" href="#content">Skip to the text</a>
<header>
  <a class="name" href="${to("index.html")}">sdfc</a>
  <nav aria-label="Main"><a href="${to("tutorial.html")}">Tutorial</a> <a href="${to("reference/index.html")}">Reference</a>
    <a href="${to("gallery.html")}">Gallery</a> <a href="${to("playground/index.html")}">Playground</a></nav>
  <form role="search"><input type="search" id="search" placeholder="Search" aria-label="Search" autocomplete="off">
    <ol id="found" hidden></ol></form>
</header>
<div id="columns">
<details id="contents"><summary>Contents</summary><nav aria-label="Pages">${parts.join("")}</nav></details>
<main id="content">
${page.content}</main>
</div>
<script type="module" src="${to("search.js")}"></script>
</body>
</html>
`;
}
