// A button on each block of code that copies it.

for (const block of document.querySelectorAll("pre")) {
  const button = Object.assign(document.createElement("button"), { className: "copy", textContent: "Copy" });
  button.addEventListener("click", async () => {
    await navigator.clipboard.writeText(block.textContent);
    button.textContent = "Copied";
    setTimeout(() => (button.textContent = "Copy"), 1500);
  });
  const frame = Object.assign(document.createElement("div"), { className: "block" });
  block.replaceWith(frame);
  frame.append(block, button);
}
