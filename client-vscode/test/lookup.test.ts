import assert from "node:assert/strict";
import { test } from "node:test";
import { type Surroundings, findServer, searchFolders } from "../src/lookup";

/** A Linux machine with one folder open, where exactly the given programs exist. */
function machine(programs: readonly string[], changes: Partial<Surroundings> = {}): Surroundings {
  return {
    setting: "",
    trusted: true,
    folders: ["/srv/cell"],
    python: undefined,
    searchPath: "/usr/local/bin:/usr/bin",
    installed: undefined,
    home: "/home/ada",
    platform: "linux",
    isExecutable: (path) => programs.includes(path),
    ...changes,
  };
}

const EVERYWHERE = [
  "/opt/robbdd-lsp",
  "/envs/robots/bin/robbdd-lsp",
  "/srv/cell/.venv/bin/robbdd-lsp",
  "/usr/bin/robbdd-lsp",
];

/** The command found, or the problem. */
function outcome(around: Surroundings): string {
  const lookup = findServer(around);
  return lookup.found ? lookup.command : lookup.problem;
}

test("the setting wins over everything", () => {
  const around = machine(EVERYWHERE, { setting: "/opt/robbdd-lsp", python: "/envs/robots/bin/python" });
  assert.equal(outcome(around), "/opt/robbdd-lsp");
});

test("a setting that names nothing is a problem, not a reason to start another server", () => {
  assert.match(outcome(machine(EVERYWHERE, { setting: "/opt/gone" })), /"\/opt\/gone", which is not a program/);
});

test("a relative setting is refused", () => {
  assert.match(outcome(machine(EVERYWHERE, { setting: "bin/robbdd-lsp" })), /not an absolute path/);
});

test("the setting understands the home folder and the workspace folder", () => {
  const programs = ["/home/ada/bin/robbdd-lsp", "/srv/cell/tools/robbdd-lsp"];
  assert.equal(outcome(machine(programs, { setting: "~/bin/robbdd-lsp" })), programs[0]);
  assert.equal(outcome(machine(programs, { setting: "${workspaceFolder}/tools/robbdd-lsp" })), programs[1]);
});

test("the selected Python environment comes before .venv", () => {
  assert.equal(outcome(machine(EVERYWHERE, { python: "/envs/robots/bin/python" })), "/envs/robots/bin/robbdd-lsp");
});

test("a selected environment without the server is passed over", () => {
  assert.equal(outcome(machine(EVERYWHERE, { python: "/usr/local/bin/python" })), "/srv/cell/.venv/bin/robbdd-lsp");
});

test(".venv comes before PATH, in the order of the folders", () => {
  const programs = ["/b/.venv/bin/robbdd-lsp", "/usr/bin/robbdd-lsp"];
  assert.equal(outcome(machine(programs, { folders: ["/a", "/b"] })), "/b/.venv/bin/robbdd-lsp");
});

test("PATH is searched in its order", () => {
  assert.equal(outcome(machine(["/usr/bin/robbdd-lsp", "/usr/local/bin/robbdd-lsp"])), "/usr/local/bin/robbdd-lsp");
});

test("a relative entry of PATH is never used", () => {
  assert.match(outcome(machine(["./robbdd-lsp", "robbdd-lsp"], { searchPath: ".::bin" })), /was not found/);
});

test("an untrusted workspace cannot provide a server", () => {
  const around = machine(["/srv/cell/.venv/bin/robbdd-lsp", "/envs/robots/bin/robbdd-lsp"], {
    trusted: false,
    python: "/envs/robots/bin/python",
    searchPath: "/srv/cell/.venv/bin:/usr/bin",
  });
  assert.match(outcome(around), /was not found.*not trusted/);
});

test("an untrusted workspace still gets the server on PATH", () => {
  assert.equal(outcome(machine(EVERYWHERE, { trusted: false })), "/usr/bin/robbdd-lsp");
});

test("the server that the extension installed comes last, and serves an untrusted workspace, too", () => {
  const own = "/home/ada/storage/server-1/bin/robbdd-lsp";
  assert.equal(outcome(machine([own, ...EVERYWHERE], { installed: own })), "/srv/cell/.venv/bin/robbdd-lsp");
  assert.equal(outcome(machine([own], { installed: own, trusted: false })), own);
});

test("programs of an untrusted workspace's folders of PATH are not used to install anything", () => {
  const around = machine([], { trusted: false, searchPath: "/srv/cell/bin:bin:/usr/bin" });
  assert.deepEqual(searchFolders(around), ["/usr/bin"]);
});

test("a missing server can be installed, a wrong setting must be corrected", () => {
  const installable = (setting: string): boolean => {
    const lookup = findServer(machine([], { setting }));
    return !lookup.found && lookup.installable;
  };
  assert.deepEqual([installable(""), installable("/opt/gone")], [true, false]);
});

test("a missing server says what can be done and where it was looked for", () => {
  const lookup = findServer(machine([], { python: "/envs/robots/bin/python" }));
  assert.ok(!lookup.found);
  assert.match(lookup.problem, /was not found\. It can be installed/);
  assert.deepEqual(lookup.tried, [
    "/envs/robots/bin/robbdd-lsp",
    "/srv/cell/.venv/bin/robbdd-lsp",
    "/usr/local/bin/robbdd-lsp",
    "/usr/bin/robbdd-lsp",
  ]);
});

test("on Windows the programs are in Scripts and end in .exe", () => {
  const windows = (python: string, program: string) =>
    outcome(
      machine([program], { platform: "win32", python, folders: ["C:\\cell"], searchPath: "", home: "C:\\Users\\ada" }),
    );
  const program = "C:\\env\\Scripts\\robbdd-lsp.exe";
  assert.equal(windows("C:\\env\\Scripts\\python.exe", program), program);
  assert.equal(windows("C:\\env\\python.exe", program), program);
  assert.equal(windows("C:\\other\\python.exe", "C:\\cell\\.venv\\Scripts\\robbdd-lsp.exe"), "C:\\cell\\.venv\\Scripts\\robbdd-lsp.exe");
});
