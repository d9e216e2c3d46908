// The index of the search: one entry for each section of each page.

import MiniSearch from "minisearch";
import { OPTIONS } from "./search_options.js";

/// The length of the text that is shown with a result, in characters.
const SHOWN = 140;

/// Returns the index as JSON.
export function index(pages) {
  const search = new MiniSearch(OPTIONS);
  const entries = pages.flatMap((page) => page.sections.map(({ title, anchor, text }) => {
    const plain = text.join(" ").replace(/\]\([^)]*\)|<[^>]*>|[[\]`*]/g, " ").replace(/\s+/g, " ").trim();
    const url = anchor ? `${page.url}#${anchor}` : page.url;
    return { title, page: page.title, url, text: plain, start: plain.slice(0, SHOWN) };
  }));
  search.addAll(entries.map((entry, id) => ({ id, ...entry })));
  return JSON.stringify(search);
}
