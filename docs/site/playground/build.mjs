// Builds the playground into a folder: node build.mjs FOLDER. `bundle.py` adds the language core.
import { copyFile, mkdir } from "node:fs/promises";
import { join } from "node:path";
import esbuild from "esbuild";

const here = import.meta.dirname;
const out = process.argv[2];
const RUNTIME = ["pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json"];

await mkdir(join(out, "pyodide"), { recursive: true });
await Promise.all(RUNTIME.map((name) => copyFile(join(here, "node_modules/pyodide", name), join(out, "pyodide", name))));
await Promise.all(["index.html", "worker.js", "language_core.py"].map((name) => copyFile(join(here, name), join(out, name))));
await esbuild.build({
  entryPoints: [join(here, "playground.js")],
  outfile: join(out, "playground.bundle.js"),
  bundle: true,
  minify: true,
  format: "esm",
  logLevel: "warning",
});
