// Untrusted code is not run by any command, and the server is informed.
import assert from "node:assert/strict";
import { mkdirSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import manifest from "../package.json";
import { SERVER } from "../src/lookup";
import { programIn } from "../src/setup/steps";
import { LanguageClient } from "./languageclient.kit";
import { CancellationTokenSource, Uri, editor, workspace } from "./vscode.kit";
import { MODEL, client, command, openWindow, until } from "./window.kit";

/** Commands of the server that run nothing of a workspace. */
const HARMLESS = ["robbdd.cancel", "robbdd.estimate", "robbdd.gherkin", "robbdd.steps"];
const RUNNING = ["robbdd.run", "robbdd.rerunFailed", "robbdd.record"];
/** Commands of the server that the palette executes without asking: it runs a file, and debugs it. */
const OFFERED = ["robbdd.run", ...RUNNING];
const REFUSED = "Nothing was run: scenarios run code of this workspace, which you do not trust yet.";
const PALETTE = manifest.contributes.commands.map((entry) => entry.command).filter((name) => name !== "robbdd.restartServer");

const toldTrust = () => LanguageClient.made.map(({ options }) => options.initializationOptions["trusted"]);
const refusals = () => editor.problems.filter((problem) => problem === REFUSED).length;

for (const trusted of [true, false]) {
  test(`the server hears as it starts that the workspace is ${trusted ? "" : "not "}trusted`, async () => {
    openWindow({ trusted });
    editor.opened.fire({ languageId: "robbdd" });
    await until(() => LanguageClient.made.some((one) => one.isRunning()));
    assert.deepEqual(toldTrust(), [trusted]);
  });
}

test("when the workspace is trusted another server is started, which hears of that, and scenarios run", async () => {
  openWindow({ trusted: false });
  await command("robbdd.runFile");
  const before = client();
  editor.trust();
  await command("robbdd.runFile");
  assert.deepEqual(toldTrust(), [false, true]);
  assert.deepEqual([before.isRunning(), client().isRunning()], [false, true]);
  assert.deepEqual([before.executed, client().executed], [[], ["robbdd.run"]]);
});

test("no command of the palette runs anything that is not trusted", async () => {
  openWindow({ trusted: false });
  for (const name of PALETTE) {
    await command(name);
  }
  assert.deepEqual(client().executed.filter((name) => !HARMLESS.includes(name)), []);
  assert.equal(refusals(), OFFERED.length);
});

test("the palette's commands run trusted code", async () => {
  openWindow();
  for (const name of PALETTE) {
    await command(name);
  }
  assert.deepEqual(client().executed.filter((name) => !HARMLESS.includes(name)), OFFERED);
});

for (const name of RUNNING) {
  test(`a lens with ${name} is refused unless the workspace is trusted`, async () => {
    for (const trusted of [false, true]) {
      openWindow({ trusted });
      await command("robbdd.previewGherkin");
      await command("robbdd.cancelRun");
      const { executed, options } = client();
      executed.length = 0;
      await options.middleware.executeCommand(name, [{ uri: MODEL.toString() }]);
      assert.deepEqual(executed, trusted ? [name] : []);
    }
  });
}

for (const profile of ["Run", "Run with Recording"]) {
  test(`"${profile}" of the Testing view shows at its tests that they are not trusted`, async () => {
    openWindow({ trusted: false });
    await editor.profiles.get(profile)?.({}, new CancellationTokenSource().token);
    assert.deepEqual(client().executed, []);
    assert.equal(refusals(), 1);
    assert.deepEqual(editor.errored, [`fetch: ${REFUSED}`, `sort: ${REFUSED}`]);

    openWindow();
    await editor.profiles.get(profile)?.({}, new CancellationTokenSource().token);
    assert.deepEqual(client().executed, [profile === "Run" ? "robbdd.run" : "robbdd.record"]);
  });
}

test("a continuous run does not begin with a save in a workspace that is not trusted", async () => {
  for (const trusted of [false, true]) {
    openWindow({ trusted });
    await editor.controller.resolveHandler(undefined);
    await editor.profiles.get("Run")?.({ continuous: true }, new CancellationTokenSource().token);
    editor.saved.fire({ uri: MODEL });
    await until(() => refusals() + client().executed.length > 0);
    assert.deepEqual(client().executed, trusted ? ["robbdd.run"] : []);
  }
});

test("a server in the workspace is started only if the workspace is trusted", async () => {
  for (const trusted of [false, true]) {
    const folder = join(openWindow({ trusted }), "cell");
    const program = programIn(join(folder, ".venv"), SERVER, process.platform);
    mkdirSync(dirname(program), { recursive: true });
    writeFileSync(program, "", { mode: 0o755 });
    workspace.workspaceFolders = [{ uri: Uri.file(folder) }];
    editor.settings = {};
    await command("robbdd.cancelRun");
    assert.equal(LanguageClient.made.some(({ server }) => server.command === program), trusted);
  }
});

test("the server works in an empty folder of the extension", async () => {
  const storage = openWindow();
  await command("robbdd.cancelRun");
  const { cwd } = client().server.options;
  assert.equal(dirname(cwd), storage);
  assert.deepEqual(readdirSync(cwd), []);
});

test("if that folder cannot be created, the user sees that no server could be started", async () => {
  const storage = openWindow();
  rmSync(storage, { recursive: true, force: true });
  writeFileSync(storage, "no folder");
  await command("robbdd.cancelRun");
  assert.deepEqual(LanguageClient.made, []);
  assert.match(editor.problems[0] ?? "", /could not be started\. See the log/);
});
