// Builds the extension, the pages of its web views and the TextMate grammars. `--test` builds the unit tests instead of the bundles,
// `--production` drops source maps, `--watch` keeps building.
import { mkdir, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import esbuild from "esbuild";
import { grammars } from "../syntaxes/grammars.mjs";

const flags = new Set(process.argv.slice(2));
const root = join(import.meta.dirname, "..");
const out = join(root, "out");

const shared = {
  absWorkingDir: root,
  bundle: true,
  platform: "node",
  target: "node20",
  format: "cjs",
  logLevel: "warning",
  // Icons are drawings in the page.
  loader: { ".svg": "text" },
};

async function writeGrammars() {
  await mkdir(join(out, "syntaxes"), { recursive: true });
  for (const [name, grammar] of Object.entries(grammars)) {
    await writeFile(join(out, "syntaxes", `${name}.tmLanguage.json`), `${JSON.stringify(grammar)}\n`);
  }
}

async function buildTests() {
  const folder = join(root, "test");
  const files = (await readdir(folder)).filter((name) => name.endsWith(".test.ts"));
  await rm(join(out, "test"), { recursive: true, force: true });
  await esbuild.build({
    ...shared,
    entryPoints: files.map((name) => join(folder, name)),
    outdir: join(out, "test"),
    // The editor and the server are played by the tests.
    alias: { vscode: "./test/vscode.kit.ts", "vscode-languageclient/node": "./test/languageclient.kit.ts" },
    logOverride: { "import-is-undefined": "error" },
    // These load files from their own folder.
    external: ["vscode-oniguruma", "vscode-textmate"],
  });
}

/** Write the licences of the packages that ended up in the bundles; theirs ask for that. */
async function writeNotices(inputs) {
  const packages = new Set(
    inputs.flatMap((path) => /^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1] ?? []),
  );
  const notices = [];
  for (const folder of [...packages].sort()) {
    const { name, version } = JSON.parse(await readFile(join(root, folder, "package.json"), "utf8"));
    const file = (await readdir(join(root, folder))).find((entry) => /^licen[cs]e/i.test(entry));
    if (file === undefined) {
      throw new Error(`${name} carries no licence file: it cannot be bundled`);
    }
    notices.push(`${name} ${version}\n\n${(await readFile(join(root, folder, file), "utf8")).trim()}\n`);
  }
  await writeFile(join(out, "THIRD_PARTY.txt"), notices.join(`\n${"-".repeat(80)}\n\n`));
}

const production = flags.has("--production");

/** What is built: the extension, and the pages of its web views, which run in a browser. */
const bundles = [
  {
    ...shared,
    entryPoints: ["src/extension.ts"],
    outfile: "out/extension.js",
    external: ["vscode"],
    // The ES modules of the language client's dependencies bundle without their UMD wrappers' dynamic requires.
    mainFields: ["module", "main"],
  },
  {
    ...shared,
    entryPoints: Object.fromEntries(["comparison", "graph", "history", "replay", "scene", "study"].map((page) => [page, `webviews/${page}/main.ts`])),
    outdir: "out/webviews",
    platform: "browser",
    target: "es2022",
    format: "iife",
  },
].map((bundle) => ({ ...bundle, minify: production, sourcemap: !production, metafile: true }));

async function buildExtension() {
  await rm(join(out, "webviews"), { recursive: true, force: true });
  if (flags.has("--watch")) {
    await Promise.all(bundles.map(async (bundle) => (await esbuild.context(bundle)).watch()));
    return;
  }
  const built = await Promise.all(bundles.map((bundle) => esbuild.build(bundle)));
  await writeNotices(built.flatMap(({ metafile }) => Object.keys(metafile.inputs)));
}

await writeGrammars();
await (flags.has("--test") ? buildTests() : buildExtension());
