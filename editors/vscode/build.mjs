// Bundles the extension and the script of its preview panel.
import { build } from "esbuild";

const minify = !process.argv.includes("--readable");
await build({
  entryPoints: ["src/extension.ts"],
  bundle: true,
  platform: "node",
  target: "node20",
  format: "cjs",
  external: ["vscode"],
  outfile: "dist/extension.js",
  minify,
});
await build({
  entryPoints: ["src/panel.ts"],
  bundle: true,
  platform: "browser",
  target: "es2022",
  format: "iife",
  outfile: "dist/panel.js",
  minify,
});
