// The messages between the extension and the page of a preview.

import type { Camera } from "./orbit";
import type { Param, Picture, Value } from "./session";

export type ToPage =
  | { kind: "params"; params: Param[]; values: Record<string, Value> }
  | { kind: "picture"; picture: Picture }
  | { kind: "problem"; message: string };

export type FromPage =
  | { kind: "ready"; width: number; height: number }
  | { kind: "size"; width: number; height: number }
  | { kind: "set"; name: string; value: Value }
  | { kind: "look"; camera: Camera | null }
  | { kind: "reset" };
