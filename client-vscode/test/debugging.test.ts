// Debugging: what the server is asked for, and what the debugger connects to.
import assert from "node:assert/strict";
import { test } from "node:test";
import { LanguageClient } from "./languageclient.kit";
import { CancellationTokenSource, editor } from "./vscode.kit";
import { MODEL, client, command, openWindow, until } from "./window.kit";

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
  assert.deepEqual({ ...(editor.adapter({ configuration: SESSION }) as object) }, { port: 4711, host: "127.0.0.1" });
  assert.equal(editor.adapter({ configuration: {} }), undefined);
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
