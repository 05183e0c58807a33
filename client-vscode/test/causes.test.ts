// Of several clauses with one cause, only the cause has the reason; the others name it.
import assert from "node:assert/strict";
import { test } from "node:test";
import type { ClauseJudged, RunMessage } from "../src/runs/messages";
import { RunReport } from "../src/runs/report";
import { Causes } from "../src/runs/causes";
import { folded, outcomeOf } from "../src/testing/outcomes";

const UNREACHABLE = "panda cannot reach a free place";
const NEVER = `event evt-pick-end never occurred: ${UNREACHABLE}`;

const violated = (reason: string) => ({ verdict: "violated", failure: `${reason} (violated)` }) as const;
const unknown = (reason: string) => ({ verdict: "unknown", failure: `${reason} (unknown)` }) as const;
const holds = { verdict: "holds", failure: "" } as const;

test("clauses that wait for an event of a failed behaviour are consequences of it", () => {
  const causes = new Causes();
  assert.equal(causes.add("at-source", holds), undefined);
  assert.equal(causes.add("carry", violated(UNREACHABLE)), undefined);
  assert.equal(causes.add("in-hand", unknown(NEVER)), "unknown because of carry");
  assert.equal(causes.add("at-goal", unknown(NEVER)), "unknown because of carry");
});

test("without a failed behaviour, the first clause that is unknown for a reason is the cause of the others", () => {
  const causes = new Causes();
  assert.equal(causes.add("in-hand", unknown("timed out")), undefined);
  assert.equal(causes.add("at-goal", unknown("timed out")), "unknown for the same reason as in-hand");
  assert.equal(causes.add("untouched", unknown("the trace has no record of 'cube'")), undefined);
});

test("a violated clause is no consequence, and a verdict without a reason is no cause", () => {
  const causes = new Causes();
  causes.add("carry", violated(UNREACHABLE));
  assert.equal(causes.add("at-goal", violated(UNREACHABLE)), undefined);
  const bare = new Causes();
  bare.add("first", { verdict: "violated", failure: "violated by −12 mm at 3.20 s" });
  assert.equal(bare.add("second", { verdict: "unknown", failure: "unknown" }), undefined);
});

test("a clause that is repeated in a scenario is not its own cause", () => {
  const causes = new Causes();
  causes.add("in-hand", unknown("timed out"));
  assert.equal(causes.add("in-hand", unknown("timed out")), undefined);
});

test("a consequence has errored and names its cause, without a message of its own", () => {
  const judged = { ...unknown(NEVER), robustness: null, unit: "", at: null, reason: NEVER };
  const outcome = outcomeOf(judged, "thing = cube");
  assert.equal(folded(outcome, undefined), outcome);
  const text = "unknown because of carry";
  assert.deepEqual(folded(outcome, text), { state: "errored", note: text, failure: { text, folded: true } });
});

test("the report of a run has the reason once in a scenario, and again in the next", () => {
  const clause = (index: number, name: string, verdict: ClauseJudged["verdict"], reason: string): RunMessage => ({
    type: "ClauseJudged", index, line: 7, name, sentence: name, verdict, robustness: null, unit: "", at: null, reason,
    failure: `${reason} (${verdict})`,
  });
  const run = new RunReport("fetch.bdd");
  const lines = [0, 1].flatMap((index) => [
    { type: "ScenarioStarted", index, name: "t:fetch", values: "" } as const,
    clause(index, "carry", "violated", UNREACHABLE),
    clause(index, "in-hand", "unknown", NEVER),
    { type: "ScenarioFinished", index, simulated: 9, wall: 0.5, stepping: 0.3 } as const,
  ]).flatMap((message) => run.add(message));
  const clauses = lines.filter((line) => /[✗?]/.test(line)).map((line) => line.trim());
  const once = [`✗ carry: violated: ${UNREACHABLE}`, "? in-hand: unknown because of carry"];
  assert.deepEqual(clauses, [...once, ...once]);
});
