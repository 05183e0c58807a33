// Paths: the checkout, the cache filled by setup.sh, and the results.
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

export const ROOT = resolve(import.meta.dirname, "../../../..");
export const CACHE = process.env.ROBBDD_WORKBENCH_CACHE ?? join(ROOT, ".workbench");
export const EXAMPLES = join(ROOT, "examples");
export const SAMPLES = resolve(import.meta.dirname, "../samples");
export const SCREENSHOTS = join(ROOT, "build", "workbench");
export const VSIX = process.env.ROBBDD_VSIX ?? join(ROOT, "client-vscode", "robbdd-workbench.vsix");
export const LANGUAGE_SERVER = process.env.ROBBDD_LSP ?? join(ROOT, ".venv", "bin", "robbdd-lsp");
export const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
/** How many times slower than this machine's the processor of the window is. */
export const SLOWDOWN = Number(process.env.ROBBDD_WORKBENCH_SLOWDOWN ?? 1);

/** Return a path, or fail with the command that creates it. */
export function required(path, remedy) {
  if (!existsSync(path)) {
    throw new Error(`${path} is not there: ${remedy}`);
  }
  return path;
}

/** The entry script of code-server. */
export function codeServerEntry() {
  return required(join(CACHE, "node_modules/code-server/out/node/entry.js"), "run tests/editors/workbench/setup.sh");
}

/** The playwright-core package of the cache. */
export function playwright() {
  const manifest = required(join(CACHE, "package.json"), "run tests/editors/workbench/setup.sh");
  return createRequire(manifest)("playwright-core");
}
