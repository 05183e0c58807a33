import assert from "node:assert/strict";
import { test } from "node:test";
import { type ClauseJudged, type RunMessage, isRunNotification } from "../src/runs/messages";
import { RunReport } from "../src/runs/report";
import { message } from "./messages.kit";

const judged = (index: number, verdict: "holds" | "violated" | "unknown", more: Partial<ClauseJudged> = {}): RunMessage =>
  message("ClauseJudged", { index, sentence: "cube is located at bin", verdict, ...more });
const started = (index: number): RunMessage => message("ScenarioStarted", { index });
const finished = (index: number): RunMessage => message("ScenarioFinished", { index });
const runStarted = (total: number): RunMessage => ({ type: "RunStarted", total, simulator: "mujoco 4.0.0" });

function report(...messages: RunMessage[]): { lines: string[]; run: RunReport } {
  const run = new RunReport("cell/fetch.bdd");
  return { lines: messages.flatMap((message) => run.add(message)), run };
}

test("a run reads from its start to its summary", () => {
  const { lines } = report(
    runStarted(2),
    started(0),
    message("ClauseStarted"),
    judged(0, "holds", { robustness: 0.03123, unit: "m", at: 4.5 }),
    finished(0),
    started(1),
    judged(1, "violated", { robustness: -0.004, unit: "m", at: 3.2, reason: "the bin was pushed" }),
    finished(1),
    { type: "RunFinished", ok: true },
  );
  assert.deepEqual(lines, [
    "▶ cell/fetch.bdd: 2 scenarios, mujoco 4.0.0",
    "  Scenario 1 of 2: t:fetch -- 1  part = cube",
    "    ✔ cube is located at bin: holds by +31.2 mm at 4.50 s",
    "    passed after 9.00 s simulated, 0.51 s on the clock",
    "  Scenario 2 of 2: t:fetch -- 1  part = cube",
    "    ✗ cube is located at bin: violated by −4.00 mm at 3.20 s: the bin was pushed",
    "    failed after 9.00 s simulated, 0.51 s on the clock",
    "■ cell/fetch.bdd: 1 of 2 scenarios passed, 1 failed.",
    "",
  ]);
});

test("scenarios that are executed side by side are reported one after the other", () => {
  const { lines } = report(runStarted(3), started(0), started(1), judged(1, "holds"), judged(0, "holds"), finished(1));
  const rest = report(runStarted(2), started(0), judged(0, "holds")).run.interrupt("Gone.");
  assert.deepEqual(
    lines.map((line) => line.trim().split(/[ :]/, 2).join(" ")),
    ["▶ cell/fetch.bdd", "Scenario 2", "✔ cube", "passed after"],
  );
  assert.equal(rest.length, 4);
  assert.ok(rest[0]?.startsWith("  Scenario 1 of 2"));
});

test("a margin is given in a unit that reads well, and only where it has one", () => {
  const line = (robustness: number, unit: string) =>
    report(started(0), judged(0, "holds", { robustness, unit }), finished(0)).lines[1];
  assert.equal(line(0.9994, "m"), "    ✔ cube is located at bin: holds by +999 mm");
  assert.equal(line(1.5, "m"), "    ✔ cube is located at bin: holds by +1.50 m");
  assert.equal(line(-0.25, "m/s"), "    ✔ cube is located at bin: holds by −0.250 m/s");
  assert.equal(line(1, ""), "    ✔ cube is located at bin: holds");
});

test("a scenario with an unknown clause has errored, not passed", () => {
  const { run } = report(runStarted(1), started(0), judged(0, "holds"), judged(0, "unknown"), finished(0));
  assert.deepEqual(run.tally, { total: 1, passed: 0, failed: 0, errored: 1 });
});

test("a violated clause outweighs an unknown one", () => {
  const { run } = report(runStarted(1), started(0), judged(0, "unknown"), judged(0, "violated"), finished(0));
  assert.deepEqual(run.tally, { total: 1, passed: 0, failed: 1, errored: 0 });
});

test("a scenario without a judged clause has errored", () => {
  const { run } = report(runStarted(1), started(0), finished(0));
  assert.equal(run.tally.errored, 1);
});

test("clauses of scenarios that run at the same time are kept apart", () => {
  const { run } = report(
    runStarted(2),
    started(0),
    started(1),
    judged(1, "violated"),
    judged(0, "holds"),
    finished(1),
    finished(0),
  );
  assert.deepEqual(run.tally, { total: 2, passed: 1, failed: 1, errored: 0 });
});

test("a run that ends early reports it and counts the open scenarios", () => {
  const { lines, run } = report(runStarted(3), started(0), { type: "RunFinished", ok: false });
  assert.ok(lines.includes("■ The run ended early. cell/fetch.bdd: 0 of 3 scenarios passed, 3 not finished."));
  assert.ok(run.finished);
});

test("an interrupted run is finished, and only once", () => {
  const { run } = report(runStarted(1));
  assert.equal(run.interrupt("The language server stopped.").length, 2);
  assert.deepEqual(run.interrupt("The language server stopped."), []);
});

test("a log text of several lines keeps its indentation on each", () => {
  const { lines } = report({ type: "LogLine", level: "warning", text: "slow\ncontact" });
  assert.deepEqual(lines, ["    warning: slow", "    warning: contact"]);
});

test("a notification of another shape is not taken for a run message", () => {
  const uri = "file:///cell/fetch.bdd";
  assert.ok(isRunNotification({ run: "1", uri, message: started(0) }));
  assert.ok(isRunNotification({ run: "1", uri, message: { ...judged(0, "holds"), newer: "field" } }));
  for (const wrong of [
    undefined,
    { run: "1", uri },
    { run: "1", message: started(0) },
    { run: "1", uri, message: { type: "toString" } },
    { run: "1", uri, message: { ...started(0), index: "0" } },
    { run: "1", uri, message: { ...judged(0, "holds"), verdict: "perhaps" } },
  ]) {
    assert.ok(!isRunNotification(wrong), JSON.stringify(wrong));
  }
});

const FAILED = { id: "e1", lines: ["carrying:Carry failed", '  File "/cell/carrying.py", line 33, in reset', "KeyError: 'goal'"] };

test("an error in users' code is shown once with its traceback, and its output with its scenario", () => {
  const spoilt = (index: number): RunMessage[] => [
    started(index),
    { type: "Output", index, text: "one\ntwo" },
    message("UserCodeFailed", { index, ...FAILED }),
    judged(index, "unknown", { reason: "carrying:Carry failed: KeyError: 'goal' (/cell/carrying.py:33)", fault: "e1" }),
    finished(index),
  ];
  const { lines } = report(runStarted(2), { type: "Output", index: null, text: "loading" }, ...spoilt(0), ...spoilt(1));
  assert.deepEqual(lines.slice(1, 11), [
    "    │ loading",
    "    error 1: carrying:Carry failed",
    '      File "/cell/carrying.py", line 33, in reset',
    "    KeyError: 'goal'",
    "  Scenario 1 of 2: t:fetch -- 1  part = cube",
    "    │ one",
    "    │ two",
    "    ? cube is located at bin: unknown: no evidence, because of error 1",
    "    errored after 9.00 s simulated, 0.51 s on the clock",
    "  Scenario 2 of 2: t:fetch -- 1  part = cube",
  ]);
  assert.equal(lines.filter((line) => line.includes("KeyError")).length, 1);
});

test("an error of code that all scenarios share has no scenario, and one that is no error is not understood", () => {
  const notification = (said: object) => isRunNotification({ run: "1", uri: "file:///m.bdd", message: said });
  const shared = message("UserCodeFailed", { index: null, ...FAILED });
  assert.ok(notification(shared));
  assert.ok(!notification({ ...shared, lines: [7] }));
});
