// Of several clauses with one cause, only the cause has the reason; the server says which clauses are its consequences.
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Because, ClauseJudged, RunMessage } from "../src/runs/messages";
import { RunReport } from "../src/runs/report";
import { folded, outcomeOf } from "../src/testing/outcomes";

const UNREACHABLE = "panda cannot reach a free place";
const NEVER = `event evt-pick-end never occurred: ${UNREACHABLE}`;
const BECAUSE: Because = { clause: "https://x/carry", position: 1, words: "unknown because of carry" };

test("a consequence has errored and names its cause, without a message of its own", () => {
  const judged = {
    verdict: "unknown", failure: `${NEVER} (unknown)`, robustness: null, unit: "", at: null, reason: NEVER,
  } as const;
  const outcome = outcomeOf(judged, "thing = cube");
  for (const none of [undefined, null]) {
    assert.equal(folded(outcome, none), outcome);
  }
  const text = "unknown because of carry";
  assert.deepEqual(folded(outcome, BECAUSE), { state: "errored", note: text, failure: { text, folded: true } });
});

test("the report of a run has the reason of a cause, and at its consequences the name of the cause", () => {
  const clause = (name: string, verdict: ClauseJudged["verdict"], reason: string, because?: Because | null): RunMessage => ({
    type: "ClauseJudged", index: 0, line: 7, name, sentence: name, verdict, robustness: null, unit: "", at: null, reason,
    failure: `${reason} (${verdict})`, ...(because === undefined ? {} : { because }),
  });
  const run = new RunReport("fetch.bdd");
  const lines = [
    { type: "ScenarioStarted", index: 0, name: "t:fetch", values: "" } as const,
    clause("carry", "violated", UNREACHABLE, null),
    clause("in-hand", "unknown", NEVER, BECAUSE),
    // Equal texts alone fold nothing, and a server of an earlier version names no causes.
    clause("at-goal", "unknown", UNREACHABLE),
    { type: "ScenarioFinished", index: 0, simulated: 9, wall: 0.5, stepping: 0.3 } as const,
  ].flatMap((message) => run.add(message));
  assert.deepEqual(lines.filter((line) => /[✗?]/.test(line)).map((line) => line.trim()), [
    `✗ carry: violated: ${UNREACHABLE}`,
    "? in-hand: unknown because of carry",
    `? at-goal: unknown: ${UNREACHABLE}`,
  ]);
});
