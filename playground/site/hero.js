// The scene of the first page: its picture, until the browser has drawn it.

const frame = document.querySelector(".live iframe");
if (frame) {
  frame.src = frame.dataset.src;
  // A browser that cannot draw the scene keeps the picture: after 30 seconds nobody looks any more.
  const look = (left = 300) => {
    const { state } = frame.contentDocument?.body?.dataset ?? {};
    if (state === "drawn") frame.classList.add("ready");
    else if (left > 0) setTimeout(look, 100, left - 1);
  };
  look();
}
