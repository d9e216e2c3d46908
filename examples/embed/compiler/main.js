// Compiles the scene in the text area whenever it changes, and draws it. Serve it from the root of
// the repository.

import { load } from "../../../crates/web/npm/index.js";
import { clock, sliders } from "../reflection.js";
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
    // While the source has errors, the last good picture stays.
    if (text === null) return;
    endClock();
    const { setParams } = await picture(device, canvas, text, reflection);
    form.replaceChildren();
    sliders(reflection, form, setParams);
    endClock = clock(reflection, setParams);
  }

  // Edits are compiled one after the other. Of the edits that wait, only the last is compiled.
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
