// Builds the playground into a folder: node build.mjs FOLDER, in the folder of the repository. `bundle.py` adds the language
// core, `recordings.py` the recorded executions. The page that replays them is that of the VS Code extension.
import { copyFile, mkdir } from "node:fs/promises";
import { join, resolve } from "node:path";
import esbuild from "esbuild";

const here = import.meta.dirname;
const out = process.argv[2];
const RUNTIME = ["pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json"];

await mkdir(join(out, "pyodide"), { recursive: true });
await Promise.all(RUNTIME.map((name) => copyFile(join(here, "node_modules/pyodide", name), join(out, "pyodide", name))));
await Promise.all(["index.html", "replay.html", "worker.js", "language_core.py"].map((name) => copyFile(join(here, name), join(out, name))));
await esbuild.build({
  entryPoints: [join(here, "playground.js")],
  outfile: join(out, "playground.bundle.js"),
  bundle: true,
  minify: true,
  format: "esm",
  logLevel: "warning",
});
await esbuild.build({
  entryPoints: { replay: resolve("client-vscode/webviews/replay/main.ts") },
  outdir: out,
  bundle: true,
  minify: true,
  target: "es2022",
  loader: { ".svg": "text" },
  logLevel: "warning",
});
