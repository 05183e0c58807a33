// Runs the language core in a thread of its own: one call after the other, each with its answer.
import { loadPyodide } from "./pyodide/pyodide.mjs";

const SITE_PACKAGES = "/lib/python3.14/site-packages";

async function start() {
  const [python, archive, core] = await Promise.all([
    loadPyodide(),
    fetch("core.zip").then((answer) => answer.arrayBuffer()),
    fetch("language_core.py").then((answer) => answer.text()),
  ]);
  python.unpackArchive(archive, "zip", { extractDir: SITE_PACKAGES });
  python.runPython(core);
  return python.runPython("serve(Playground())");
}

const started = start();

addEventListener("message", async ({ data: { id, method, args } }) => {
  try {
    const call = await started;
    postMessage({ id, answer: JSON.parse(call(method, JSON.stringify(args))) });
  } catch (error) {
    postMessage({ id, error: String(error) });
  }
});
