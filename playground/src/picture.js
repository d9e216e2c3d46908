// The page's side of drawing: a canvas that keeps the last picture, and a worker that draws.

/// Draws on `canvas`. `events` has the functions `asked`, `opened`, `built`, `progress`, `drawn`,
/// `refused` and `lost`.
export class Picture {
  #canvas;
  #context;
  #events;
  #only;
  #worker = null;
  #id = 0;
  #turn = 0;
  #makeWorker;
  /// True if the worker has the last scene and has not refused it.
  hasProgram = false;
  /// The last still picture as a file. The canvas loses its content with the GPU.
  #kept = null;
  #places = 0;

  /// `only` is `webgpu` or `webgl2` if the other is not to be used.
  constructor(canvas, events, makeWorker, only) {
    this.#canvas = canvas;
    this.#context = canvas.getContext("2d", { alpha: false });
    this.#events = events;
    this.#only = only;
    this.#makeWorker = makeWorker;
    canvas.addEventListener("contextrestored", () => this.#restore());
  }

  /// Starts the worker, which reports its backend.
  start() {
    this.#worker = this.#makeWorker();
    this.#worker.onmessage = ({ data }) => this.#receive(data);
    this.#worker.postMessage({ type: "open", only: this.#only });
  }

  /// Ends the worker, whatever it does. The picture stays.
  stop() {
    this.#worker?.terminate();
    this.#worker = null;
    this.hasProgram = false;
  }

  get isRunning() {
    return this.#worker !== null;
  }

  /// Replaces the scene and draws its first frame.
  show(text, reflection, frame) {
    this.hasProgram = this.isRunning;
    this.#worker?.postMessage({ type: "scene", id: ++this.#id, text, reflection });
    this.draw(frame);
  }

  /// Draws a frame of the scene. A slow frame that is being drawn ends after its coarse picture.
  draw(frame) {
    if (!this.hasProgram) return;
    this.#events.asked?.();
    this.#worker.postMessage({ type: "frame", id: this.#id, turn: ++this.#turn, ...frame });
  }

  #receive(message) {
    const { type, id } = message;
    if (type === "tiles") return this.#place(message);
    if (id !== undefined && id !== this.#id) return;
    if (type === "refused") this.hasProgram = false;
    const isLast = message.turn === this.#turn;
    if (type === "done" && message.isWhole && isLast && !message.moves) this.#keep();
    const name = { done: "drawn", unavailable: "lost" }[type] ?? type;
    this.#events[name]?.({ ...message, isLast });
  }

  /// Puts strips of a picture in their place, scaled to the canvas.
  #place({ tiles, width, height, part }) {
    this.#places += 1;
    delete this.#canvas.dataset.kept;
    const { width: w, height: h } = this.#canvas;
    for (const { bitmap, y } of tiles) {
      const [top, bottom] = [y, y + bitmap.height].map((row) => Math.round((row * h) / height));
      this.#context.drawImage(bitmap, 0, top, w, bottom - top);
      bitmap.close();
    }
    this.#events.progress(part);
  }

  /// Keeps the picture outside the GPU. `data-kept` says that it is kept; tests wait for it.
  #keep() {
    const places = this.#places;
    this.#canvas.toBlob((file) => {
      if (places !== this.#places) return;
      this.#kept = file;
      this.#canvas.dataset.kept = "";
    });
  }

  async #restore() {
    delete this.#canvas.dataset.kept;
    if (!this.#kept) return;
    const places = this.#places;
    const bitmap = await createImageBitmap(this.#kept);
    const { width, height } = this.#canvas;
    // What was drawn meanwhile is newer.
    if (places !== this.#places) return;
    this.#context.drawImage(bitmap, 0, 0, width, height);
    this.#canvas.dataset.kept = "";
  }

  /// Gives the canvas another size and keeps its picture.
  resize(width, height) {
    const canvas = this.#canvas;
    if (canvas.width === width && canvas.height === height) return false;
    const old = new OffscreenCanvas(canvas.width, canvas.height);
    old.getContext("2d").drawImage(canvas, 0, 0);
    Object.assign(canvas, { width, height });
    this.#context.drawImage(old, 0, 0, width, height);
    return true;
  }
}
