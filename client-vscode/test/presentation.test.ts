import assert from "node:assert/strict";
import { test } from "node:test";
import { afterInstallation, type ServerState, isRunProgress, present } from "../src/presentation";
import { RestartBudget } from "../src/restarts";

const READY: ServerState = { kind: "ready", command: "/usr/bin/robbdd-lsp" };

test("a ready server says where it comes from", () => {
  const { text, tooltip, severity } = present(READY, [], "");
  assert.deepEqual([text, severity], ["$(check) RobBDD", "normal"]);
  assert.match(tooltip, /\/usr\/bin\/robbdd-lsp/);
});

test("runs at the same time are counted together", () => {
  const runs = [
    { finished: 3, total: 14 },
    { finished: 1, total: 2 },
  ];
  assert.equal(present(READY, runs, "").text, "$(loading~spin) RobBDD 4/16");
});

test("the number of ended scenarios is said once, and the server's own progress of a run is not shown too", () => {
  const { text, tooltip } = present(READY, [{ finished: 3, total: 14 }], "");
  assert.match(text, /3\/14/);
  assert.doesNotMatch(tooltip, /\d/);
  assert.ok(isRunProgress("robbdd-run-1"));
  assert.ok(!isRunProgress("robbdd-rejudge-1") && !isRunProgress(1));
});

test("a screen reader hears the progress and the state, not the names of icons", () => {
  assert.equal(present(READY, [{ finished: 3, total: 14 }], "").said, "RobBDD: 3 of 14 scenarios have ended.");
  assert.match(present(READY, [], "fetch.bdd: 1 of 2 scenarios passed, 1 failed.").said, /^RobBDD: Last run: fetch\.bdd: 1 of 2 scenarios passed, 1 failed\./);
  assert.equal(present({ kind: "failed", problem: "It is not there." }, [], "").said, "RobBDD: It is not there.");
});

test("after a run its summary is shown and a click leads to the runs", () => {
  const { tooltip, command } = present(READY, [], "fetch.bdd: 2 of 2 scenarios passed.");
  assert.match(tooltip, /^Last run: fetch\.bdd: 2 of 2 scenarios passed\./);
  assert.equal(command, "robbdd.showRuns");
});

test("a failed server shows its problem and offers what to do", () => {
  const { tooltip, severity, command } = present({ kind: "failed", problem: "It is not there." }, [], "");
  assert.deepEqual([tooltip, severity, command], ["It is not there.", "error", "robbdd.statusActions"]);
});

test("a click on the item of a missing server installs it", () => {
  const { tooltip, severity, command } = present({ kind: "missing", problem: "It is nowhere." }, [], "");
  assert.deepEqual([tooltip, severity, command], ["It is nowhere. Click to install it.", "warning", "robbdd.installServer"]);
});

test("a server that is starting is not ready", () => {
  assert.match(present({ kind: "starting" }, [], "").text, /sync~spin/);
});

test("a server may crash three times in three minutes, but not four", () => {
  const budget = new RestartBudget();
  assert.deepEqual([0, 1000, 2000, 3000].map((time) => budget.crashed(time)), [true, true, true, false]);
});

test("crashes of long ago are forgotten", () => {
  const budget = new RestartBudget();
  const minute = 60_000;
  assert.deepEqual([0, 1, 2, 3, 4, 5].map((index) => budget.crashed(2 * minute * index)), Array(6).fill(true));
});

test("an installation that failed says so with a way to retry, and a cancelled one changes nothing", () => {
  const before = { kind: "missing", problem: "It is nowhere." } as const;
  const after = afterInstallation({ kind: "failed", problem: "the disk is full" }, before);
  const { text, tooltip, severity, command } = present(after, [], "");
  assert.ok(!text.includes("spin"));
  assert.equal(tooltip, "The RobBDD language server could not be installed: the disk is full. Click to install it.");
  assert.deepEqual([severity, command], ["warning", "robbdd.installServer"]);
  assert.equal(afterInstallation({ kind: "cancelled" }, before), before);
});
