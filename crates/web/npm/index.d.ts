export interface Options {
  /** What messages call the scene. */
  name?: string;
  target?: "wgsl" | "glsl" | "glsl-es" | "hlsl" | "msl" | "spirv" | "shadertoy";
  emit?: "field" | "march" | "render";
  stage?: "compute" | "fragment";
  /** The ray method; the scene's, or `auto`, without. */
  march?: string;
  /** Start of every name, `sdf_` without. */
  prefix?: string;
  group?: number;
  binding?: number;
  /** Numbers of the scene become params. */
  slots?: boolean;
  /** Texts that the scene may import, by path. It can read no others. */
  files?: Record<string, string>;
}

export interface Diagnostic {
  /** Explained in docs/errors.md; null where the call is wrong, not the scene. */
  code: string | null;
  severity: "error" | "warning";
  message: string;
  file: string;
  /** Lines and columns count from 1; 0 without a place. */
  line: number;
  column: number;
  end_line: number;
  end_column: number;
  help: string;
}

export interface Compiled {
  /** The shader; null with errors, and for SPIR-V. */
  text: string | null;
  /** The words of SPIR-V; null for all else. */
  words: number[] | null;
  /** As `sdfc compile --reflect` writes it: docs/targets.md. Null with errors. */
  reflection: Record<string, any> | null;
  /** Errors and warnings, in order of place. */
  diagnostics: Diagnostic[];
}

export interface Compiler {
  /** Never throws, whatever it is given. */
  compile(source: string, options?: Options): Compiled;
}

/** Reads the compiler, from beside this module unless told otherwise: an address, or the bytes. */
export function load(wasm?: string | URL | BufferSource): Promise<Compiler>;
