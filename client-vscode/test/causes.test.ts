// Of several clauses with one cause, only the cause has the reason; the server says which clauses are its consequences.
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Because, ClauseJudged } from "../src/runs/messages";
import { RunReport } from "../src/runs/report";
import { folded, outcomeOf } from "../src/testing/outcomes";
import { message } from "./messages.kit";

const UNREACHABLE = "panda cannot reach a free place";
const NEVER = `event evt-pick-end never occurred: ${UNREACHABLE}`;
const BECAUSE: Because = { clause: "https://x/carry", position: 1, words: "unknown because of carry" };

test("a consequence is skipped and names its cause, unless that one is not shown", () => {
  const judged = {
    verdict: "unknown", failure: `${NEVER} (unknown)`, robustness: null, unit: "", at: null, reason: NEVER,
  } as const;
  const outcome = outcomeOf(judged, "thing = cube");
  for (const none of [undefined, null]) {
    assert.equal(folded(outcome, none, true), outcome);
  }
  assert.equal(folded(outcome, BECAUSE, false), outcome);
  assert.deepEqual(folded(outcome, BECAUSE, true), { state: "skipped", note: "unknown because of carry" });
});

test("the report of a run has the reason of a cause, and at its consequences the name of the cause", () => {
  const clause = (name: string, verdict: ClauseJudged["verdict"], reason: string, because: Because | null = null) =>
    message("ClauseJudged", { name, sentence: name, verdict, reason, failure: `${reason} (${verdict})`, because });
  const run = new RunReport("fetch.bdd");
  const lines = [
    message("ScenarioStarted"),
    clause("carry", "violated", UNREACHABLE),
    clause("in-hand", "unknown", NEVER, BECAUSE),
    // Equal texts alone fold nothing.
    clause("at-goal", "unknown", UNREACHABLE),
    message("ScenarioFinished"),
  ].flatMap((said) => run.add(said));
  assert.deepEqual(lines.filter((line) => /[✗?]/.test(line)).map((line) => line.trim()), [
    `✗ carry: violated: ${UNREACHABLE}`,
    "? in-hand: unknown because of carry",
    `? at-goal: unknown: ${UNREACHABLE}`,
  ]);
});
