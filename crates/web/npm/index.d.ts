export interface Options {
  /** The name of the scene in messages. */
  name?: string;
  target?: "wgsl" | "glsl" | "glsl-es" | "hlsl" | "msl" | "spirv" | "shadertoy";
  emit?: "field" | "march" | "render";
  stage?: "compute" | "fragment";
  /** The ray method. Default: that of the scene, or `auto`. */
  march?: string;
  /** The prefix of every name. Default: `sdf_`. */
  prefix?: string;
  group?: number;
  binding?: number;
  /** Literals of the scene become params. */
  live_literals?: boolean;
  /** Values of params by name, written as in a scene: `0.5`, `90deg`, `#d94f30`. */
  set?: Record<string, string>;
  /**
   * Values of params by name, as the reflection states them. Only params in `fixed_params` are set;
   * a value that such a param does not take is ignored. With `set`, all are ignored.
   */
  values?: Record<string, number | number[]>;
  /** The sources that the scene may import, by path. */
  files?: Record<string, string>;
}

export interface Diagnostic {
  /** Explained in docs/errors.md; null if the call is wrong, not the scene. */
  code: string | null;
  severity: "error" | "warning";
  message: string;
  file: string;
  /** Lines and columns count from 1; 0 if there is no position. */
  line: number;
  column: number;
  end_line: number;
  end_column: number;
  help: string;
  /** Changes of the source that fix the problem, best first. */
  fixes: Fix[];
}

export interface Fix {
  /** A few words that say what changes. */
  title: string;
  /** The parts of the source that are replaced; they do not overlap. Positions are as above. */
  edits: {
    file: string;
    line: number;
    column: number;
    end_line: number;
    end_column: number;
    text: string;
  }[];
}

export interface Compiled {
  /** The source of the shader; null with errors, and for SPIR-V. */
  text: string | null;
  /** The words of SPIR-V; null for other targets. */
  words: number[] | null;
  /** As `sdfc compile --reflect` writes it (docs/targets.md); null with errors. */
  reflection: Record<string, any> | null;
  /** Errors and warnings, in the order of their positions. */
  diagnostics: Diagnostic[];
}

export interface Compiler {
  /**
   * Never throws, for any input. A scene that is nested too deeply for the browser's stack has an
   * error, and the compiler starts again. In a page that takes a moment, and until then every scene
   * has an error that says so.
   */
  compile(source: string, options?: Options): Compiled;
}

/** Loads the compiler from a URL or from bytes. Default: `sdfc.wasm` beside this module. */
export function load(wasm?: string | URL | BufferSource): Promise<Compiler>;
