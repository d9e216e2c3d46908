// What a preview asks of the server, and when. It knows neither VS Code nor the page.

import type { Camera } from "./orbit";

export type Value = number | boolean | string;

/** A param as `sdfc/params` lists it. */
export interface Param {
  name: string;
  kind: "number" | "int" | "angle" | "bool" | "color" | "choice";
  default: Value;
  min: number | null;
  max: number | null;
  choices: string[];
}

export interface Picture {
  png: string;
  camera: Camera;
  device: string;
  notes: string[];
}

/** What the page shows. */
export interface Shown {
  params(params: Param[], values: Record<string, Value>): void;
  picture(picture: Picture): void;
  /** The scene has errors, or cannot be drawn; the last picture stays. */
  problem(message: string): void;
}

/** Asks the server. `cancelled` resolves when the answer is not needed any more. */
export type Ask = (method: string, params: object, cancelled: AbortSignal) => Promise<unknown>;

/** The time that a picture may take while someone drags, in milliseconds. */
const FLUENT = 60;
/** The time without a change of the view after which the picture gets its full size. */
const QUIET = 200;

/**
 * The preview of one scene. It asks for one picture at a time. While the view changes, pictures are
 * as small as they must be to follow; then the last one is drawn in full.
 */
export class Session {
  private values: Record<string, Value> = {};
  private params: Param[] = [];
  private paramsAreOld = true;
  private camera: Camera | undefined;
  private size: [number, number] | undefined;
  /** Milliseconds for each pixel of the last picture. */
  private pace = 0;
  /** A change came after the question that is being answered. */
  private pending = false;
  private coarse = false;
  private running: AbortController | undefined;
  private loop: Promise<void> | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly uri: string,
    private readonly ask: Ask,
    private readonly shown: Shown,
    private readonly delay: () => number,
  ) {}

  /** The text changed: asks again when typing pauses. */
  changed(): void {
    this.paramsAreOld = true;
    this.running?.abort();
    this.later(this.delay());
  }

  /** The page has another size, in pixels. */
  resize(width: number, height: number): Promise<void> {
    this.size = [width, height];
    return this.draw(true);
  }

  /** Moves the camera; undefined for the scene's own. */
  look(camera: Camera | undefined): Promise<void> {
    this.camera = camera;
    return this.draw(true);
  }

  set(name: string, value: Value): Promise<void> {
    this.values[name] = value;
    return this.draw(true);
  }

  /** Gives all params their defaults. */
  reset(): Promise<void> {
    this.values = {};
    this.shown.params(this.params, this.values);
    return this.draw(true);
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.pending = false;
    this.running?.abort();
  }

  private later(milliseconds: number): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.draw(false), milliseconds);
  }

  /** Draws what is wanted now. It resolves when nothing is left to draw. */
  private draw(coarse: boolean): Promise<void> {
    clearTimeout(this.timer);
    // A picture in full would hold up the view; a small one may end.
    if (!this.coarse) this.running?.abort();
    this.coarse = coarse;
    this.pending = true;
    this.loop ??= this.drawAll().finally(() => (this.loop = undefined));
    return this.loop;
  }

  private async drawAll(): Promise<void> {
    while (this.pending) {
      this.pending = false;
      const running = new AbortController();
      this.running = running;
      try {
        await this.drawOne(running.signal);
      } catch (error) {
        if (!running.signal.aborted) {
          this.shown.problem(error instanceof Error ? error.message : String(error));
        }
      }
    }
    this.running = undefined;
  }

  private async drawOne(signal: AbortSignal): Promise<void> {
    if (this.paramsAreOld) {
      const answer = await this.question("sdfc/params", {}, signal);
      this.paramsAreOld = false;
      this.params = (answer as { params: Param[] }).params;
      this.keepValues();
      this.shown.params(this.params, this.values);
    }
    const { camera, values } = this;
    if (!this.size) return;
    const [width, height] = this.size;
    const wanted = Math.sqrt(FLUENT / Math.max(this.pace * width * height, 1e-9));
    const factor = this.coarse ? Math.min(Math.max(wanted, 1 / 8), 1) : 1;
    const size = [width, height].map((side) => Math.max(1, Math.round(side * factor)));
    const start = performance.now();
    const picture = await this.question("sdfc/preview", { size, camera, values }, signal);
    this.pace = (performance.now() - start) / (size[0]! * size[1]!);
    this.shown.picture(picture as Picture);
    if (factor < 1 && !this.pending) this.later(QUIET);
  }

  private async question(method: string, params: object, signal: AbortSignal) {
    const document = { textDocument: { uri: this.uri } };
    const answer = await this.ask(method, { ...document, ...params }, signal);
    if (signal.aborted) throw new Error("cancelled");
    return answer;
  }

  /** Drops values that the params no longer take, so that an edit never blocks the preview. */
  private keepValues(): void {
    const fits = (param: Param, value: Value): boolean => {
      if (param.kind === "choice") return param.choices.includes(String(value));
      if (typeof value !== typeof param.default) return false;
      if (typeof value !== "number") return true;
      return value >= (param.min ?? -Infinity) && value <= (param.max ?? Infinity);
    };
    const kept = this.params.filter((it) => it.name in this.values && fits(it, this.values[it.name]!));
    this.values = Object.fromEntries(kept.map((it) => [it.name, this.values[it.name]!]));
  }
}
