// The search.

import MiniSearch from "minisearch";
import { OPTIONS } from "./search_options.js";

const MOST = 12;
const { root } = document.body.dataset;
const input = document.getElementById("search");
const found = document.getElementById("found");

let search = null;
const ready = () => (search ??= fetch(`${root}search.json`).then((response) => response.text())
  .then((json) => MiniSearch.loadJSON(json, OPTIONS)));

async function show() {
  const words = input.value.trim();
  if (words === "") return (found.hidden = true);
  const index = await ready();
  if (words !== input.value.trim()) return;
  const options = { prefix: true, fuzzy: 0.15, boost: { title: 4, page: 2 }, combineWith: "AND" };
  const rows = index.search(words, options).slice(0, MOST);
  found.replaceChildren(...rows.map(({ title, page, url, start }) => {
    const item = document.createElement("li");
    const link = Object.assign(document.createElement("a"), { href: root + url });
    const where = document.createElement("small");
    where.textContent = start;
    link.append(title === page ? title : `${page}: ${title}`, where);
    item.append(link);
    return item;
  }));
  if (rows.length === 0) found.append(Object.assign(document.createElement("li"), { textContent: "Nothing found" }));
  found.hidden = false;
}

input.addEventListener("focus", ready);
input.addEventListener("input", show);
document.addEventListener("keydown", (event) => {
  const isTyping = /^(?:INPUT|TEXTAREA)$/.test(document.activeElement.tagName);
  if (event.key === "/" && !isTyping) {
    event.preventDefault();
    input.focus();
  } else if (event.key === "Escape") {
    found.hidden = true;
  } else if (/^Arrow(?:Up|Down)$/.test(event.key) && !found.hidden) {
    const links = [input, ...found.querySelectorAll("a")];
    const next = links.indexOf(document.activeElement) + (event.key === "ArrowDown" ? 1 : -1);
    links[(next + links.length) % links.length].focus();
    event.preventDefault();
  }
});
document.addEventListener("click", ({ target }) => {
  if (!input.form.contains(target)) found.hidden = true;
});
input.form.addEventListener("submit", (event) => {
  event.preventDefault();
  found.querySelector("a")?.click();
});
