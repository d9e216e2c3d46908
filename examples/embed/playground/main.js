// Compiles the scene in the text area whenever it changes, and draws it. Served from the root of the repository.

import { load } from "../../../crates/web/npm/index.js";
import { clock, knobs } from "../reflection.js";
import { openDevice, picture } from "../webgpu/picture.js";

const [canvas, editor, messages, form] = ["canvas", "textarea", "pre", "form"].map((name) =>
  document.querySelector(name),
);

async function main() {
  const [compiler, device] = await Promise.all([load(), openDevice()]);
  let endClock = () => {};

  async function show() {
    const options = { emit: "render", stage: "fragment" };
    const { text, reflection, diagnostics } = compiler.compile(editor.value, options);
    messages.textContent = diagnostics.map(line).join("\n");
    // A broken text keeps the last good picture.
    if (text === null) return;
    endClock();
    const { setParams } = await picture(device, canvas, text, reflection);
    form.replaceChildren();
    knobs(reflection, form, setParams);
    endClock = clock(reflection, setParams);
  }

  // One after the other, and of those that wait only the last.
  let latest = 0;
  let work = show();
  editor.oninput = () => {
    const asked = ++latest;
    document.body.dataset.state = "";
    work = work.then(() => asked === latest && show()).then(ready, failed);
  };
  await work;
}

function ready() {
  document.body.dataset.state = "drawn";
}

function failed(error) {
  document.body.dataset.state = "failed";
  document.querySelector("p").textContent = error.message;
}

function line({ line, column, severity, message, help }) {
  return `${line}:${column}: ${severity}: ${message}${help && ` (${help})`}`;
}

main().then(ready, failed);
