// How the server is started, which versions belong together, and what a report and a terminal get of them.
import assert from "node:assert/strict";
import { delimiter, dirname } from "node:path";
import { test } from "node:test";
import { launchOf, serverVariables } from "../src/launch";
import { fits } from "../src/versions";
import { LanguageClient } from "./languageclient.kit";
import { editor } from "./vscode.kit";
import { client, command, openWindow, terminal } from "./window.kit";

/** Open a window with a server of a version and these settings; it runs when this returns. */
async function start(version: string | undefined, settings: Readonly<Record<string, unknown>> = {}): Promise<void> {
  openWindow();
  LanguageClient.version = version;
  editor.settings = { ...editor.settings, ...settings };
  await command("robbdd.restartServer");
}

test("arguments and variables of the settings reach the server, and entries of other types do not", async () => {
  await start(undefined, { "server.arguments": ["--log-file", "x.log", 7], "server.environment": { ROS_DOMAIN_ID: "7", bad: 1 } });
  const { args, options } = client().server;
  assert.deepEqual([args, options.env], [["--log-file", "x.log"], { ROS_DOMAIN_ID: "7" }]);
  assert.deepEqual(launchOf(undefined, null), { args: [], env: {} });
});

test("Python reads no module path of the environment before the server's first line", () => {
  const inherited = { PYTHONPATH: ":/opt/ros", PythonInspect: "1", PYTHONSTARTUP: "x.py", PATH: "/bin", PYTHONHASHSEED: "0" };
  const hidden = { PYTHONPATH: undefined, PythonInspect: undefined, PYTHONSTARTUP: undefined };
  assert.deepEqual(serverVariables(inherited, { A: "1" }), { ...hidden, A: "1", ROBBDD_PYTHONPATH: ":/opt/ros" });
  assert.deepEqual(serverVariables({ PYTHONPATH: "a" }, { PYTHONPATH: "b" }), { PYTHONPATH: undefined, ROBBDD_PYTHONPATH: "b" });
  assert.deepEqual(serverVariables({}, {}), {});
});

test("the server is started without a module path", async () => {
  process.env["PYTHONPATH"] = ":";
  try {
    await start(undefined);
    const { env } = client().server.options;
    assert.deepEqual([env["PYTHONPATH"], "PYTHONPATH" in env, env["ROBBDD_PYTHONPATH"]], [undefined, true, ":"]);
  } finally {
    delete process.env["PYTHONPATH"];
  }
});

test("new terminals find the command line of the server in use, behind what is on PATH", async () => {
  await start(undefined);
  assert.equal(terminal.get("PATH"), `${delimiter}${dirname(process.execPath)}`);
});

test("versions fit if they differ in the patch only", () => {
  const pairs = [["1.0.3", "1.0"], ["1.0", "1.1"], ["2.0.0", "1.0.0"], ["a checkout", "1.0"]] as const;
  assert.deepEqual(pairs.map(([server, extension]) => fits(server, extension)), [true, false, false, true]);
});

test("a server that does not fit is reported, once", async () => {
  await start("1.0.9");
  assert.deepEqual(editor.problems, []);
  await start("2.1.0");
  await command("robbdd.restartServer");
  assert.deepEqual(editor.problems, [
    `The language server ${process.execPath} has version 2.1.0, this extension 1.0: parts of it may not work. Install the same version of both.`,
  ]);
});

for (const [answer, python, mujoco] of [
  [{ python: "CPython 3.11.7", mujoco: "4.0.0" }, "CPython 3.11.7", "4.0.0"],
  [{ python: "CPython 3.11.7", mujoco: null }, "CPython 3.11.7", "not installed"],
  [undefined, "unknown", "unknown"],
] as const) {
  test(`a report names the versions of all parts, with Python ${python} and MuJoCo ${mujoco}`, async () => {
    await start("1.0.9");
    LanguageClient.answers.set("robbdd/versions", () => answer);
    await command("robbdd.reportIssue");
    const text = editor.texts.at(-1) ?? "";
    const served = `language server: 1.0.9 (${process.execPath})`;
    for (const line of ["extension: 1.0", served, `Python: ${python}`, `MuJoCo: ${mujoco}`, "editor: Editor 1.91.0", `system: ${process.platform}`]) {
      assert.ok(text.includes(`- ${line}\n`) || text.includes(`- ${line} `), `${line} is not in ${text}`);
    }
  });
}
