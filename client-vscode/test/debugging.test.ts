// Debugging: what the server is asked for, and what the debugger connects to.
import assert from "node:assert/strict";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { FILE, scenario } from "./testing.kit";
import { LanguageClient } from "./languageclient.kit";
import { CancellationTokenSource, editor } from "./vscode.kit";
import { MODEL, client, command, openWindow, until } from "./window.kit";

const LISTS = Object.fromEntries(["shapes", "meshes", "bodies", "workspaces", "events", "clauses"].map((name) => [name, []]));
const NUMBERS = { type: "float32", shape: [0], data: "" };
const FRAMES = { times: NUMBERS, poses: NUMBERS, bodies: [] };
const SCENARIO = { index: 0, name: "t:fetch -- 1", values: "", story: "", variant: "", variation: 1, repetition: 1, seed: 1, verdict: "unknown", trace: true };
const TRACE = { run: 1, folder: "file:///run", scenario: SCENARIO, remark: "", frames: FRAMES, ...LISTS };
const SESSION = { type: "robbdd", request: "attach", name: "RobBDD", port: 4711, justMyCode: true };

/** The options of the runs that the server was asked for; its process waits for a debugger. */
function runs(): Record<string, unknown>[] {
  openWindow();
  const asked: Record<string, unknown>[] = [];
  LanguageClient.answers.set("workspace/executeCommand", (params: { command: string; arguments: [Record<string, unknown>] }) => {
    const [{ token, uri, ...options }] = params.arguments;
    if (params.command === "robbdd.run") {
      asked.push(options);
      const message = { type: "DebuggerAwaited", port: 4711 };
      client().listeners.get("robbdd/runMessage")?.({ run: token, uri, message });
    }
    return {};
  });
  return asked;
}

test("a debugged run is met by a debugger at its port, and its process is the adapter", async () => {
  const asked = runs();
  await command("robbdd.debugFile");
  assert.deepEqual(asked, [{ debug: true }]);
  assert.deepEqual(editor.debugged, [SESSION]);
  assert.deepEqual({ ...((await editor.adapter({ configuration: SESSION })) as object) }, { port: 4711, host: "127.0.0.1" });
  assert.equal(await editor.adapter({ configuration: {} }), undefined);
});

test("F5 without launch.json debugs the model in the editor with the command beside the server", async () => {
  openWindow();
  const session = (await editor.resolve(undefined, { program: "/cell/fetch.bdd" })) as Record<string, unknown>;
  assert.deepEqual(session, { type: "robbdd", request: "launch", name: "RobBDD", program: "/cell/fetch.bdd" });
  const adapter = (await editor.adapter({ configuration: session })) as { command: string; args: string[] };
  assert.equal(adapter.command, join(dirname(process.execPath), "robbdd"));
  assert.deepEqual(adapter.args, ["dap"]);
});

test("an untrusted workspace is not debugged, and the reason is shown", async () => {
  openWindow({ trusted: false });
  assert.equal(await editor.resolve(undefined, { request: "launch", program: "/cell/fetch.bdd" }), undefined);
  assert.match(editor.problems.join(), /^Trust the workspace to debug its models/);
  assert.deepEqual(await editor.resolve(undefined, SESSION), SESSION);
});

test("the paused scene is shown on request and follows each pause", async () => {
  openWindow();
  await command("robbdd.showPausedScene");
  assert.equal(editor.panels.length, 0);
  assert.match(editor.messages.join(), /^No simulation is paused/);
  const asked: string[] = [];
  const customRequest = (request: string) => {
    asked.push(request);
    const name = `t:fetch -- ${asked.length}`;
    return Promise.resolve({ ...TRACE, scenario: { ...SCENARIO, name }, duration: asked.length, paused_at: asked.length });
  };
  const session = { type: "robbdd", configuration: { request: "launch" }, customRequest };
  const tracker = editor.track(session) as { onDidSendMessage: (message: unknown) => void };
  tracker.onDidSendMessage({ event: "stopped" });
  assert.deepEqual(asked, [], "nobody looks yet");
  editor.session = session;
  await command("robbdd.showPausedScene");
  tracker.onDidSendMessage({ event: "output" });
  tracker.onDidSendMessage({ event: "stopped" });
  await until(() => asked.length === 2);
  assert.deepEqual(asked, ["robbdd/scene", "robbdd/scene"]);
  assert.equal(editor.panels.length, 1);
  const [panel] = editor.panels;
  panel?.fromPage.fire({ type: "ready" });
  const selected = () => panel?.posted.map((posted) => (posted as { clause?: unknown }).clause).at(-1);
  await until(() => selected() !== undefined);
  assert.equal(selected(), 2, "the clause at which it paused is selected");
  assert.equal(panel?.title, "Paused fetch -- 2", "and the panel names the scenario");
});

test("the server learns of a debugged run that was stored, also without a watcher of files", async () => {
  openWindow();
  await command("robbdd.runFile");
  const session = { type: "robbdd" };
  const uri = "file:///cell/.robbdd/runs/1/results.json";
  editor.debugEvent({ event: "robbdd/stored", body: { results: uri }, session });
  editor.debugEvent({ event: "robbdd/stored", body: {}, session });
  editor.debugEvent({ event: "other", body: { results: uri }, session });
  editor.debugEvent({ event: "robbdd/stored", body: { results: uri }, session: { type: "python" } });
  assert.deepEqual(client().notified, [["workspace/didChangeWatchedFiles", { changes: [{ uri, type: 1 }] }]]);
});

const LENS = { uri: FILE, scenario: "t:fetch", variant: "t:fetch" };

test("the lens of a scenario debugs the execution that the user chooses by its values", async () => {
  openWindow();
  const asked: unknown[] = [];
  LanguageClient.answers.set("robbdd/tests", (params: unknown) => {
    asked.push(params);
    return { problem: null, files: [FILE], tests: [scenario(1), scenario(2)] };
  });
  const launch = { type: "robbdd", request: "launch", name: "RobBDD", program: "/cell/fetch.bdd", scenario: "t:fetch" };
  editor.choices.push("cube2");
  await command("robbdd.debugScenario", { ...LENS, count: 2 });
  assert.deepEqual(editor.debugged, [{ ...launch, variation: 2 }]);
  assert.deepEqual(asked, [{ uri: FILE, variant: "t:fetch", most: 1000 }]);
  const words = editor.lists[0]?.map(({ label, description }) => `${label} (${description})`);
  assert.deepEqual(words, ["part = cube1 (scenario 1)", "part = cube2 (scenario 2)"]);
  // Without a choice, nothing is debugged.
  await command("robbdd.debugScenario", { ...LENS, count: 2 });
  assert.equal(editor.debugged.length, 1);
  // The only scenario needs no choice.
  await command("robbdd.debugScenario", { ...LENS, count: 1 });
  assert.deepEqual([editor.debugged.at(-1), asked.length, editor.lists.length], [launch, 2, 2]);
  // Of thousands, the title says how many are listed.
  await command("robbdd.debugScenario", { ...LENS, count: 5000 });
  assert.deepEqual(editor.titles, [
    "Debug: which scenario?", "Debug: which scenario?", "Debug: which scenario of the first 2 of 5,000?",
  ]);
});

test("an execution with one listed scenario, and a model without a lens, are debugged without a choice", async () => {
  openWindow();
  LanguageClient.answers.set("robbdd/tests", () => ({ problem: null, files: [FILE], tests: [scenario(1)] }));
  const launch = { type: "robbdd", request: "launch", name: "RobBDD", program: "/cell/fetch.bdd" };
  await command("robbdd.debugScenario", { ...LENS, count: null });
  await command("robbdd.debugScenario", { uri: FILE });
  assert.deepEqual(editor.debugged, [{ ...launch, scenario: "t:fetch" }, launch]);
  assert.deepEqual(editor.lists, []);
  // What is no list of tests starts nothing.
  LanguageClient.answers.set("robbdd/tests", () => undefined);
  await command("robbdd.debugScenario", { ...LENS, count: null });
  assert.equal(editor.debugged.length, 2);
});

test("so is a run of selected tests", async () => {
  const asked = runs();
  await editor.controller.resolveHandler(undefined);
  await editor.profiles.get("Debug")?.({}, new CancellationTokenSource().token);
  assert.deepEqual(asked, [{ only: [{ variant: "t:fetch" }, { variant: "t:sort" }], debug: true }]);
  assert.deepEqual(editor.debugged, [SESSION]);
});

test("a run without its debugger is cancelled: it would wait for ever", async () => {
  runs();
  editor.debugs = false;
  await command("robbdd.debugFile", MODEL);
  await until(() => client().executed.includes("robbdd.cancel"));
  assert.deepEqual(editor.problems, ["The debugger could not be started: the run is cancelled."]);
});
