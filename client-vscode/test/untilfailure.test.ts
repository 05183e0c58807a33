// Run until it fails: the requests to the server, and the messages to the user.
import assert from "node:assert/strict";
import { test } from "node:test";
import { failedIn } from "../src/runs/untilFailure";
import { LanguageClient } from "./languageclient.kit";
import { CancellationTokenSource, editor } from "./vscode.kit";
import { MODEL, command, openWindow } from "./window.kit";

const COUNTS = { total: 3, holds: 2, violated: 1, unknown: 0 };
const OUTCOME = { run: "1", ...COUNTS, cancelled: false, failed: 2, stored: { run: 4, folder: "" }, pictures: [] };

/** The targets of the runs that the server was asked for; it answers that the third execution failed. */
function runs(): Record<string, unknown>[] {
  openWindow();
  const asked: Record<string, unknown>[] = [];
  LanguageClient.answers.set("workspace/executeCommand", ({ arguments: [{ token, ...target }] }: { arguments: [Record<string, unknown>] }) => {
    assert.equal(typeof token, "string");
    asked.push(target);
    return OUTCOME;
  });
  return asked;
}

test("scenarios run up to the first failure, at most as often as the user says", async () => {
  const asked = runs();
  editor.typed.push("20", "0");
  await command("robbdd.runUntilFailure");
  await command("robbdd.runUntilFailure");
  assert.deepEqual(asked, [{ uri: MODEL.toString(), repeat: 20, stop_on_failure: true }]);
  assert.deepEqual(editor.problems, ["A whole number above 0, or nothing."]);
});

test("so do the tests that are selected in the Testing view", async () => {
  const asked = runs();
  await editor.controller.resolveHandler(undefined);
  editor.typed.push("");
  await editor.profiles.get("Run until It Fails…")?.({}, new CancellationTokenSource().token);
  const only = [{ variant: "t:fetch" }, { variant: "t:sort" }];
  assert.deepEqual(asked, [{ uri: MODEL.toString(), only, repeat: 100, stop_on_failure: true }]);
});

test("the failure leads to its replay", async () => {
  runs();
  const replayed: unknown[] = [];
  LanguageClient.answers.set("robbdd/trace", (recording) => {
    replayed.push(recording);
    return null;
  });
  editor.typed.push("3");
  editor.pressed.push("Replay");
  await command("robbdd.runUntilFailure");
  await new Promise((resolve) => setImmediate(resolve));
  assert.deepEqual(replayed, [{ uri: MODEL.toString(), run: 4, index: 2 }]);
  assert.deepEqual(editor.messages, ["Execution 3 of run 4 did not hold, after 2 that did."]);
});

test("if all executions held, their number is shown", async () => {
  runs();
  LanguageClient.answers.set("workspace/executeCommand", () => ({ ...OUTCOME, holds: 3, violated: 0, failed: null }));
  editor.typed.push("3");
  await command("robbdd.runUntilFailure");
  assert.deepEqual(editor.messages, ["All 3 executions held."]);
});

test("answers without a failure name none", () => {
  for (const answer of [undefined, {}, { ...OUTCOME, failed: null }, { ...OUTCOME, pictures: 1 }, { ...OUTCOME, stored: {} }, { problem: "" }]) {
    assert.equal(failedIn(answer), undefined);
  }
});
