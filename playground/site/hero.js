// The scene of the first page: its picture, until the browser has drawn it.

const frame = document.querySelector(".live iframe");
if (frame) {
  frame.src = frame.dataset.src;
  const look = () => {
    const { state } = frame.contentDocument?.body?.dataset ?? {};
    if (state === "drawn") frame.classList.add("ready");
    else setTimeout(look, 100);
  };
  look();
}
