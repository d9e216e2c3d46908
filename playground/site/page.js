// The frame of a page: head, header, navigation, footer.

import { CONTENTS } from "./pages.js";
import { relative } from "./links.js";

export const escape = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");
const ICON = "data:image/svg+xml,<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'><circle cx='4' cy='4' r='3.4' fill='%23d9733f'/></svg>";
const MAIN = [["tutorial.html", "Tutorial"], ["reference/index.html", "Reference"], ["gallery.html", "Gallery"], ["contents.html", "All pages"]];

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

/// Returns the document of a page. `site` has `version` and `repository`.
export function frame(url, title, body, site) {
  const to = (target) => escape(relative(url, target));
  const up = relative(url, "index.html").replace(/index\.html$/, "");
  const main = MAIN.map(([target, name]) => `<a href="${to(target)}"${target === url ? ' aria-current="page"' : ""}>${name}</a>`);
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>${escape(title)}</title>
<link rel="icon" href="${ICON}">
<link rel="stylesheet" href="${to("site.css")}">
<body data-root="${up || "./"}">
<a class="skip" href="#content">Skip to the text</a>
<header>
  <a class="name" href="${to("index.html")}"><span class="ball"></span>sdfc</a>
  <nav aria-label="Main">${main.join("\n    ")}</nav>
  <form role="search"><input type="search" id="search" placeholder="Search  /" aria-label="Search" autocomplete="off">
    <ol id="found" hidden></ol></form>
  <a class="button" href="${to("playground/index.html")}">Playground</a>
</header>
${body}
<footer>
  <p><b>sdfc</b> ${escape(site.version)}, under MIT or Apache 2.0</p>
  <p><a href="${site.repository}">Source</a> <a href="${to("changelog.html")}">Changes</a>
    <a href="${to("contributing.html")}">Contribute</a> <a href="${to("security.html")}">Security</a></p>
</footer>
<script type="module" src="${to("site.js")}"></script>
</body>
</html>
`;
}

/// Returns the document of a page of the documentation.
export function html(page, contents, site) {
  const link = ({ url }, name) =>
    `<a href="${escape(relative(page.url, url))}"${url === page.url ? ' aria-current="page"' : ""}>${escape(name)}</a>`;
  const item = ({ name, page: shown, inner }) => {
    const isOpen = shown === page || inner.includes(page);
    const list = inner.map((it) => `<li>${link(it, it.title)}</li>`).join("");
    return `<li>${link(shown, name)}${isOpen && list ? `<ul>${list}</ul>` : ""}</li>`;
  };
  const parts = contents.map(({ title, pages }) => `<h2>${escape(title)}</h2><ul>${pages.map(item).join("")}</ul>`);
  const body = `<div id="columns">
<details id="contents"><summary>All pages</summary><nav aria-label="Pages">${parts.join("")}</nav></details>
<main id="content">
${page.content}${neighbours(page, contents, link)}</main>
${outline(page)}</div>`;
  return frame(page.url, `${page.title} · sdfc`, body, site);
}

/// The links to the pages before and after this one.
function neighbours(page, contents, link) {
  const order = contents.flatMap(({ pages }) => pages.flatMap(({ name, page, inner }) =>
    [{ name, page }, ...inner.map((it) => ({ name: it.title, page: it }))]));
  const at = order.findIndex((it) => it.page === page);
  if (at < 0) return "";
  const side = (it, kind, word) => (it ? `<p class="${kind}"><small>${word}</small>${link(it.page, it.name)}</p>` : "<p></p>");
  return `<nav class="neighbours" aria-label="Neighbours">${side(order[at - 1], "before", "Before")}${side(order[at + 1], "next", "Next")}</nav>\n`;
}

/// The headings of a long page.
function outline({ sections }) {
  const rows = sections.filter(({ level }) => level === 2 || level === 3);
  if (rows.length < 3) return "";
  const items = rows.map(({ title, anchor, level }) => `<li class="level${level}"><a href="#${anchor}">${escape(title)}</a></li>`);
  return `<aside id="outline"><nav aria-label="On this page"><h2>On this page</h2><ul>${items.join("")}</ul></nav></aside>\n`;
}
