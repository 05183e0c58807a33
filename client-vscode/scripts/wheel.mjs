// Builds the wheel of the language server into out/server: the extension installs the server that it was packed with.
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { readFile, readdir, rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { brotliCompressSync, constants } from "node:zlib";

const root = join(import.meta.dirname, "..");
const checkout = join(root, "..");
const out = join(root, "out", "server");
const own = join(checkout, ".venv", process.platform === "win32" ? "Scripts/python.exe" : "bin/python");
const python = process.env.PYTHON ?? (existsSync(own) ? own : "python3");
// By way of the source distribution, as a release is built: it leaves out modes of files and what runs have left behind.
// The date of the commit, or a fixed one, so that the same sources make the same bytes.
const commit = spawnSync("git", ["log", "-1", "--format=%ct"], { cwd: checkout, encoding: "utf8" });
const epoch = process.env.SOURCE_DATE_EPOCH ?? (commit.stdout?.trim() || "1577836800");

await rm(out, { recursive: true, force: true });
const built = spawnSync(python, ["-I", "-m", "build", "--outdir", out, checkout], {
  env: { ...process.env, SOURCE_DATE_EPOCH: epoch },
  stdio: ["ignore", "ignore", "inherit"],
});
if (built.status === 0) {
  for (const name of (await readdir(out)).filter((file) => !file.endsWith(".whl"))) {
    await rm(join(out, name));
  }
}
const { version } = JSON.parse(await readFile(join(root, "package.json"), "utf8"));
const wheels = built.status === 0 ? await readdir(out) : [];
if (wheels.length !== 1 || !wheels[0].startsWith(`robbdd_tools-${version}-`)) {
  throw new Error(`no wheel of version ${version} was built by ${python}: ${wheels.join(", ") || "see above"}`);
}
const { status } = spawnSync(python, ["-I", join(import.meta.dirname, "store.py"), join(out, wheels[0])], {
  stdio: ["ignore", "ignore", "inherit"],
});
if (status !== 0) {
  throw new Error(`${wheels[0]} was not stored by ${python}`);
}
// As one text, a fifth smaller than what the VSIX would make of it. Level 10 and 11 would take ten times as long.
const wheel = join(out, wheels[0]);
const content = await readFile(wheel);
const params = {
  [constants.BROTLI_PARAM_QUALITY]: 9,
  [constants.BROTLI_PARAM_LGWIN]: constants.BROTLI_MAX_WINDOW_BITS,
  [constants.BROTLI_PARAM_SIZE_HINT]: content.length,
};
await writeFile(`${wheel}.br`, brotliCompressSync(content, { params }));
await rm(wheel);
