import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { chmodSync, existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, utimesSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterEach, beforeEach, test } from "node:test";
import { brotliCompressSync } from "node:zlib";
import { bundledWheel, discardAbandoned, freshFolder, installedServer, recordInstalled, unpackedWheel } from "../src/setup/environments";
import { type Installation, InstallProblem, installServer } from "../src/setup/installer";
import { failureOf, installation, packageProblem, progressOf, wantedPackage } from "../src/setup/steps";

const STEP = { title: "Installing", program: "pip", args: [] };

/** A Python that passes the probe, creates environments like itself and installs by writing `robbdd-lsp` there. */
const PYTHON = `#!/bin/sh
case "$*" in
  *"-m venv"*) mkdir -p "$4/bin" && cp "$0" "$4/bin/python" ;;
  *"-m pip"*) echo "Collecting textX<5,>=4.4"; pwd > "$(dirname "$0")/../cwd"; : > "$(dirname "$0")/robbdd-lsp" ;;
esac
`;

let folder = "";
beforeEach(() => {
  folder = mkdtempSync(join(tmpdir(), "robbdd-setup-"));
});
afterEach(() => {
  rmSync(folder, { recursive: true });
});

function program(name: string, script: string): void {
  const path = join(folder, "bin", name);
  mkdirSync(join(folder, "bin"), { recursive: true });
  writeFileSync(path, script);
  chmodSync(path, 0o755);
}

function install(changes: Partial<Installation> = {}): ReturnType<typeof installServer> {
  return installServer({
    storage: join(folder, "storage"),
    wanted: { name: "robbdd-tools==1.0", requirement: "robbdd-tools==1.0" },
    folders: [join(folder, "bin")],
    python: undefined,
    signal: new AbortController().signal,
    onProgress: () => undefined,
    onLine: () => undefined,
    ...changes,
  });
}

async function problem(changes: Partial<Installation> = {}): Promise<string> {
  try {
    await install(changes);
  } catch (error) {
    assert.ok(error instanceof InstallProblem, String(error));
    assert.deepEqual(readdirSync(join(folder, "storage")), [], "nothing is left of it");
    return error.message;
  }
  throw new Error("it was installed");
}

test("without a setting, the bundled server is installed, with the extra for videos", () => {
  const own = "robbdd-tools[video]==1.2.3";
  assert.deepEqual(wantedPackage(" ", "1.2.3"), { name: own, requirement: own });
  assert.deepEqual(wantedPackage("", "1.2.3", "/ext/a b.whl"), { name: own, requirement: "robbdd-tools[video] @ file:///ext/a%20b.whl" });
  const set = "/srv/robbdd.whl";
  assert.deepEqual(wantedPackage(set, "1.2.3", "/ext/a.whl"), { name: set, requirement: set });
});

test("the wheel of the extension's own version is found, where there is one, and unpacked", () => {
  assert.equal(bundledWheel(join(folder, "nowhere"), "1.0"), undefined);
  writeFileSync(join(folder, "robbdd_tools-0.9-py3-none-any.whl.br"), "");
  assert.equal(bundledWheel(folder, "1.0"), undefined);
  const bundled = join(folder, "robbdd_tools-1.0-py3-none-any.whl.br");
  writeFileSync(bundled, brotliCompressSync("the wheel"));
  assert.equal(bundledWheel(folder, "1.0"), bundled);
  const wheel = unpackedWheel(bundled, join(folder, "storage"));
  assert.equal(wheel, join(folder, "storage", "wheel", "robbdd_tools-1.0-py3-none-any.whl"));
  assert.equal(readFileSync(wheel, "utf8"), "the wheel");
  assert.deepEqual(readdirSync(join(folder, "storage", "wheel")), ["robbdd_tools-1.0-py3-none-any.whl"]);
});

test("a package cannot be an option of the installer", () => {
  assert.match(packageProblem("--index-url=http://elsewhere") ?? "", /not an option/);
});

test("uv creates the environment if available, else Python does", () => {
  const shown = (kind: "uv" | "python") =>
    installation({ kind, program: kind }, "/env", { name: "robbdd", requirement: "robbdd" }, "linux").map(({ program, args }) => [program, ...args].join(" "));
  assert.deepEqual(shown("uv"), ["uv venv --python >=3.11 /env", "uv pip install --python /env/bin/python -- robbdd"]);
  assert.equal(shown("python")[0], "python -I -m venv /env");
  assert.match(shown("python")[1] ?? "", /^\/env\/bin\/python -I -m pip install .* -- robbdd$/);
});

test("an installer's lines show its progress", () => {
  assert.equal(progressOf("Collecting rdflib<8,>=7.6 (from robbdd-tools==0.1.0)"), "Collecting rdflib");
  assert.equal(progressOf("  Downloading mujoco-4.0.0-cp311-manylinux.whl (6.8 MB)"), "Downloading mujoco-4.0.0-cp311-manylinux.whl");
  assert.equal(progressOf("Installing collected packages: a, b, c"), "Unpacking the packages");
  assert.equal(progressOf("Resolved 31 packages in 1.2s"), "Resolved 31 packages in 1.2s");
  assert.equal(progressOf("Requirement already satisfied: numpy"), undefined);
});

test("a failure with a known cause is explained, others show the installer's message", () => {
  assert.match(failureOf(STEP, ["The virtual environment was not created: ensurepip is not available."]), /python3-venv/);
  assert.match(failureOf(STEP, ["OSError: [Errno 28] No space left on device"]), /disk is full/);
  assert.match(failureOf(STEP, ["x NewConnectionError(...)", "ERROR: No matching distribution"]), /index cannot be reached/);
  assert.equal(failureOf(STEP, ["Collecting x", "ERROR: No matching distribution found for x", ""]), "No matching distribution found for x");
  assert.match(failureOf(STEP, []), /without an error message/);
});

test("the server is installed by the first Python that is new enough, away from the workspace's files", async () => {
  program("python3", "#!/bin/sh\nexit 1\n");
  program("python3.12", PYTHON);
  const told: string[] = [];
  const server = await install({ onProgress: (message) => told.push(message) });
  assert.ok(existsSync(server.command));
  assert.deepEqual(told, ["Looking for Python", "Creating a Python environment", "Installing robbdd-tools==1.0", "Collecting textX"]);
  assert.equal(readFileSync(join(server.command, "../../cwd"), "utf8").trim(), join(folder, "storage"));
  assert.deepEqual(installedServer(join(folder, "storage"), "another"), server);
});

test("no program of an installation is told where else Python modules are", async () => {
  program("python3", PYTHON.replace("pwd >", `env > "${join(folder, "environment")}"; pwd >`));
  const leading = ["PYTHONPATH", "PYTHONHOME", "PYTHONSTARTUP", "PYTHONUSERBASE"];
  try {
    Object.assign(process.env, Object.fromEntries(leading.map((name) => [name, "/cell:"])));
    await install();
  } finally {
    for (const name of leading) {
      Reflect.deleteProperty(process.env, name);
    }
  }
  const python = readFileSync(join(folder, "environment"), "utf8").split("\n").filter((line) => line.startsWith("PYTHON"));
  assert.deepEqual(python.sort(), ["PYTHONIOENCODING=utf-8", "PYTHONUNBUFFERED=1"]);
});

test("without a Python that is new enough it is said what to install", async () => {
  program("python3", "#!/bin/sh\nexit 1\n");
  assert.match(await problem(), /Neither uv nor Python 3\.11 or newer was found on PATH, only .*python3\. Install one/);
});

test("a package without the server is refused", async () => {
  program("python3", PYTHON.replace("robbdd-lsp", "other"));
  assert.match(await problem(), /does not contain robbdd-lsp/);
});

test("what pip says about its failure is passed on", async () => {
  program("python3", PYTHON.replace('echo "Collecting', 'echo "ERROR: no such version" >&2; exit 1; echo "'));
  assert.equal(await problem(), "no such version");
});

test("a cancelled installation ends the installer with all that it started and leaves nothing", async () => {
  const beat = join(folder, "beat");
  program("python3", PYTHON.replace("pwd >", `(while :; do echo . >> "${beat}"; sleep 0.02; done) & wait; pwd >`));
  const stop = new AbortController();
  const onLine = (line: string): void => {
    if (line.startsWith("Collecting")) {
      stop.abort();
    }
  };
  await assert.rejects(install({ signal: stop.signal, onLine }), { name: "AbortError" });
  assert.deepEqual(readdirSync(join(folder, "storage")), []);
});

test("an environment counts from its record on; the latest two are kept and the one asked for is used", () => {
  const storage = join(folder, "storage");
  const record = (name: string, minute: number): string => {
    const environment = freshFolder(storage);
    recordInstalled(storage, environment, { command: join(environment, "robbdd-lsp"), package: name });
    utimesSync(join(environment, "robbdd.json"), minute, minute * 60);
    return environment;
  };
  freshFolder(storage); // cut short
  assert.equal(installedServer(storage, "one"), undefined);
  const one = record("one", 1);
  const two = record("two", 2);
  assert.equal(installedServer(storage, "one")?.package, "one");
  assert.equal(installedServer(storage, "three")?.package, "two");
  record("three", 3);
  assert.deepEqual([existsSync(one), existsSync(two)], [false, true]);
});

test("remains of an interrupted installation are deleted, one in progress is not, nor a complete one", async () => {
  const storage = join(folder, "storage");
  const goesOn = freshFolder(storage);
  const complete = freshFolder(storage);
  recordInstalled(storage, complete, { command: join(complete, "robbdd-lsp"), package: "one" });
  const { pid } = spawnSync(process.execPath, ["--version"]);
  const left = [join(storage, `server-${pid}-abcdef`), join(storage, "server-abcdef")];
  for (const one of left) {
    mkdirSync(join(one, "lib"), { recursive: true });
  }
  await discardAbandoned(storage);
  assert.deepEqual([goesOn, complete, ...left].map((one) => existsSync(one)), [true, true, false, false]);
  await discardAbandoned(join(folder, "nowhere"));
});
