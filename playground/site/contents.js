// The list of all pages, and the headings of this one.

const contents = document.getElementById("contents");
if (contents) {
  // Beside the text the list is always open.
  const wide = matchMedia("(min-width: 900px)");
  const unfold = () => (contents.open = wide.matches);
  wide.addEventListener("change", unfold);
  unfold();
  contents.querySelector("[aria-current]")?.scrollIntoView({ block: "center" });
}

// The heading that is read is marked.
const entries = new Map([...document.querySelectorAll("#outline a")].map((link) => [link.hash.slice(1), link]));
if (entries.size > 0) {
  const heads = [...entries.keys()].map((id) => document.getElementById(id)).filter(Boolean);
  const mark = () => {
    const passed = heads.filter((head) => head.getBoundingClientRect().top < 120);
    const current = (passed.at(-1) ?? heads[0])?.id;
    for (const [id, link] of entries) {
      if (id === current) link.setAttribute("aria-current", "location");
      else link.removeAttribute("aria-current");
    }
  };
  addEventListener("scroll", mark, { passive: true });
  mark();
}
