// Builds the extension: one bundle and the TextMate grammars. `--test` builds the unit tests instead of the bundle,
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
    // These load files that lie beside them.
    external: ["vscode-oniguruma", "vscode-textmate"],
  });
}

/** Write the licences of the packages that ended up in the bundle; theirs ask for that. */
async function writeNotices(metafile) {
  const packages = new Set(
    Object.keys(metafile.inputs).flatMap((path) => /^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1] ?? []),
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

async function buildExtension() {
  const production = flags.has("--production");
  const options = {
    ...shared,
    entryPoints: ["src/extension.ts"],
    outfile: "out/extension.js",
    external: ["vscode"],
    minify: production,
    sourcemap: !production,
    metafile: true,
    // The ES modules of the language client's dependencies bundle without their UMD wrappers' dynamic requires.
    mainFields: ["module", "main"],
  };
  if (flags.has("--watch")) {
    const context = await esbuild.context(options);
    await context.watch();
  } else {
    await writeNotices((await esbuild.build(options)).metafile);
  }
}

await writeGrammars();
await (flags.has("--test") ? buildTests() : buildExtension());
