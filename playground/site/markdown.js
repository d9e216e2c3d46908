// Pages from Markdown: headings with anchors, links, coloured scenes with a link to the playground.

import { highlightTree, tagHighlighter } from "@lezer/highlight";
import MarkdownIt from "markdown-it";
import { COLORS, sdf } from "../src/language.js";
import { toFragment } from "../src/link.js";
import { relative } from "./links.js";

const { escapeHtml } = MarkdownIt().utils;
const PLAYGROUND = "playground/index.html";
/// What the compiler says about a text without anything to draw.
const DRAWS_NOTHING = "W0604";

const highlighter = tagHighlighter(COLORS.map(({ tag, name }) => [tag].flat().map((tag) => ({ tag, class: `code-${name}` }))).flat());

/// Returns a function that reads a page: it sets `content`, `title`, `anchors`, `sections` (for the
/// search) and `opens`, the number of links to the playground.
export function reader(links, compiler) {
  const markdown = new MarkdownIt({ html: true, linkify: false });
  const rules = markdown.renderer.rules;
  markdown.core.ruler.push("site", ({ tokens, env }) => {
    addAnchors(tokens, env.page);
    for (const token of inline(tokens)) {
      for (const name of ["href", "src"]) {
        if (token.attrGet(name) !== null) token.attrSet(name, links.resolve(env.page, token.attrGet(name), name === "src"));
      }
      if (token.type.startsWith("html")) token.content = rewrite(token.content, links, env.page);
    }
  });
  // Wide tables scroll by themselves.
  rules.table_open = () => '<div class="table"><table>\n';
  rules.table_close = () => "</table></div>\n";
  rules.fence = (tokens, at, options, env) => {
    const { content, info } = tokens[at];
    if (!/^sdf\b/.test(info)) return `<pre><code>${escapeHtml(content)}</code></pre>\n`;
    return `<div class="scene"><pre><code>${colored(content)}</code></pre>${opener(env, content)}</div>\n`;
  };
  rules.code_inline = (tokens, at, options, env) => {
    const { content } = tokens[at];
    const isExample = tokens[at - 1]?.content === "Example: ";
    return `<code>${escapeHtml(content)}</code>${isExample ? ` ${opener(env, content)}` : ""}`;
  };

  /// Returns the link that opens a scene in the playground, or nothing for a text that is no scene.
  function opener({ page, fragments }, source) {
    const fragment = fragments.get(source);
    if (!fragment) return "";
    page.opens += 1;
    return `<a class="open" href="${relative(page.url, PLAYGROUND)}${fragment}">Open in the playground</a>`;
  }

  /// True for a text that the playground draws. Pages about errors show their errors there.
  function isScene(page, source) {
    const { diagnostics } = compiler.compile(source);
    return page.path.startsWith("docs/errors/")
      || !diagnostics.some(({ severity, code }) => severity === "error" || code === DRAWS_NOTHING);
  }

  return async function read(page) {
    const env = { page, fragments: new Map() };
    const tokens = markdown.parse(page.text, env);
    for (const source of sources(tokens)) {
      if (isScene(page, source)) env.fragments.set(source, await toFragment({ source }));
    }
    page.content = markdown.renderer.render(tokens, markdown.options, env);
  };
}

const inline = (tokens) => tokens.flatMap((token) => [token, ...(token.children ?? [])]);

/// Returns the texts that may be scenes: blocks, and the examples of the reference.
function sources(tokens) {
  const blocks = tokens.filter(({ type, info }) => type === "fence" && /^sdf\b/.test(info));
  const examples = tokens.flatMap(({ children }) => children ?? [])
    .filter(({ type }, at, all) => type === "code_inline" && all[at - 1]?.content === "Example: ");
  return [...blocks, ...examples].map(({ content }) => content);
}

/// Gives headings the anchors that GitHub gives them, and finds the sections of the page.
function addAnchors(tokens, page) {
  // Pages may state anchors in HTML, above the heading that they belong to.
  const html = tokens.filter(({ type }) => type.startsWith("html") || type === "inline");
  const stated = html.flatMap(({ content }) => [...content.matchAll(/<a id="([^"]+)">/g)].map(([, id]) => id));
  const headings = new Set();
  page.sections = [];
  let section = null;
  for (const [at, token] of tokens.entries()) {
    if (token.type === "heading_open") {
      const { children } = tokens[at + 1];
      const title = children.map(({ type, content }) => (/^(?:text|code_inline)$/.test(type) ? content : "")).join("");
      const anchor = unused(slug(title), headings);
      headings.add(anchor);
      if (!stated.includes(anchor)) token.attrSet("id", anchor);
      page.title ??= title;
      section = { title, anchor: token.tag === "h1" ? "" : anchor, level: Number(token.tag[1]), text: [] };
      page.sections.push(section);
    } else if (/^(?:inline|fence|code_block)$/.test(token.type) && tokens[at - 1]?.type !== "heading_open") {
      section?.text.push(token.content);
    }
  }
  page.anchors = new Set([...stated, ...headings]);
}

const slug = (title) => title.toLowerCase().replace(/[^\p{L}\p{N}\s_-]/gu, "").trim().replace(/\s/g, "-");

function unused(name, taken) {
  for (let count = 0; ; count += 1) {
    const found = count === 0 ? name : `${name}-${count}`;
    if (!taken.has(found)) return found;
  }
}

/// Resolves the links in HTML.
function rewrite(text, links, page) {
  return text.replace(/ (href|src)="([^"]*)"/g, (_, name, value) => ` ${name}="${links.resolve(page, value, name === "src")}"`);
}

/// Returns the text of a scene with colours, as HTML.
export function colored(text) {
  let out = "";
  let end = 0;
  highlightTree(sdf.parser.parse(text), highlighter, (from, to, name) => {
    out += `${escapeHtml(text.slice(end, from))}<span class="${name}">${escapeHtml(text.slice(from, to))}</span>`;
    end = to;
  });
  return out + escapeHtml(text.slice(end));
}
