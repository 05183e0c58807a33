// The history of a clause, and the comparison of two runs, from the commands to what the server is asked.
import assert from "node:assert/strict";
import { test } from "node:test";
import { type ClauseChange, changeWords, isComparison, summaryOf as compared, totalsWords } from "../src/panels/comparison/answer";
import { type ClauseRun, isHistory, marginOf, rateOf, remarkOf, summaryOf, verdictOf } from "../src/panels/history/answer";
import { LanguageClient } from "./languageclient.kit";
import { WebviewPanel, editor } from "./vscode.kit";
import { MODEL, command, openWindow } from "./window.kit";

const RUN: ClauseRun = {
  run: 1,
  path: "m.bdd",
  state: "finished",
  began: "2026-01-01T10:00:00+00:00",
  judged: { holds: 3, violated: 0, unknown: 0 },
  margin: 0.012,
  unit: "m",
  worst: 2,
  stale: false,
};
const HISTORY = { clause: "https://e.org/at-goal", name: "at-goal", runs: [RUN, { ...RUN, run: 2, judged: { holds: 2, violated: 1, unknown: 0 } }] };
const STORED = { run: 1, folder: "file:///cell/1", path: "m.bdd", model: "file:///cell/m.bdd", seed: 1, complete: true, state: "finished", finished: 1, total: 1, holds: 1, violated: 0, unknown: 0, problem: null };
const CHANGE: ClauseChange = { iri: "i", name: "at-goal", before: "holds", after: "violated", margin_before: 0.012, margin_after: -0.003, unit: "m", reason: "too far" };
const COMPARISON = {
  before: STORED,
  after: { ...STORED, run: 2, folder: "file:///cell/2" },
  inputs: [],
  clauses: [],
  same: 3,
  flipped: 1,
  changes: [
    { name: "s", values: "", variant: "t:v", repetition: 1, before: null, after: null, clauses: [CHANGE] },
  ],
};

test("a run's line has its verdict, its rate, its margin and what is to be known about it", () => {
  assert.deepEqual([verdictOf(RUN), rateOf(RUN), marginOf(RUN), remarkOf(RUN)], ["holds", "3/3", "+12.0 mm", ""]);
  const cut: ClauseRun = { ...RUN, judged: { holds: 1, violated: 0, unknown: 2 }, margin: null, state: "stopped", stale: true };
  assert.deepEqual(
    [verdictOf(cut), rateOf(cut), marginOf(cut), remarkOf(cut)],
    ["unknown", "1/3", "", "stopped at the first failure, the clause has changed since"],
  );
  assert.equal(summaryOf(HISTORY), "holds in 1 of 2 runs");
});

test("a flip shows both margins and the reason", () => {
  assert.equal(changeWords(CHANGE), "at-goal ✔ → ✗ (+12.0 mm → −3.00 mm): too far");
  const unmeasured = { ...CHANGE, before: null, margin_before: null, margin_after: null, reason: "" };
  assert.equal(changeWords(unmeasured), "at-goal – → ✗");
  assert.equal(totalsWords({ holding: 3, total: 4, margin: -0.003, unit: "m" }), "3/4, worst −3.00 mm");
  assert.equal(totalsWords({ holding: 0, total: 0, margin: null, unit: "" }), "not judged");
});

test("answers of another form are refused", () => {
  assert.ok(isHistory(HISTORY));
  assert.ok(isComparison(COMPARISON));
  for (const broken of [null, {}, { ...HISTORY, runs: [{}] }, { ...COMPARISON, before: {} }, { ...COMPARISON, changes: [{}] }]) {
    assert.ok(!isHistory(broken) && !isComparison(broken));
  }
  if (isComparison(COMPARISON)) {
    assert.equal(compared(COMPARISON), "1 flipped, 3 the same, 1 only in run 1, 1 only in run 2");
  }
});

/** What the server was asked by a method. */
function asked(method: string): unknown[] {
  const requests: unknown[] = [];
  LanguageClient.answers.set(method, (params) => {
    requests.push(params);
    return method === "robbdd/history" ? HISTORY : method === "robbdd/compare" ? COMPARISON : { store: "file:///cell/runs", runs: [STORED, { ...STORED, run: 2 }] };
  });
  return requests;
}

test("two runs are chosen and compared, and the same pair is shown in the same panel", async () => {
  openWindow();
  asked("robbdd/runs");
  const compare = asked("robbdd/compare");
  await command("robbdd.compareRuns");
  await command("robbdd.compareRuns");
  const pair = { uri: MODEL.toString(), before: 1, after: 2 };
  assert.deepEqual(compare, [pair, pair]);
  assert.deepEqual(editor.panels.map(({ title }) => title), ["Run 1 → 2: 1 flipped, 3 the same, 1 only in run 1, 1 only in run 2"]);
});

test("a restored history asks for the clause of its last state, and closes without one", async () => {
  openWindow();
  const history = asked("robbdd/history");
  const choice = { uri: MODEL.toString(), clause: HISTORY.clause };
  const [panel, lost] = [new WebviewPanel("History"), new WebviewPanel("History")];
  await editor.serializers.get("robbdd.history")?.deserializeWebviewPanel(panel, { choice });
  await editor.serializers.get("robbdd.history")?.deserializeWebviewPanel(lost, {});
  assert.deepEqual(history, [choice]);
  assert.deepEqual([panel.disposed, lost.disposed], [false, true]);
});
