// Answers of the commands that run scenarios: the outcome of a run, or why nothing was run.
import assert from "node:assert/strict";
import { test } from "node:test";
import { isMomentary, outcomeOf, picturesOf, problemOf, recordedIn } from "../src/testing/answers";

const COUNTS = { total: 1, holds: 1, violated: 0, unknown: 0, cancelled: false, failed: null };
const OUTCOME = { run: "1", ...COUNTS, stored: { run: 4, folder: "file:///cell/4" }, pictures: ["file:///cell/4/a.png"] };

test("the outcome of a run has its recording and its pictures, and no problem", () => {
  assert.equal(outcomeOf(OUTCOME)?.stored.run, 4);
  assert.deepEqual([recordedIn(OUTCOME), picturesOf(OUTCOME)], ["file:///cell/4", ["file:///cell/4/a.png"]]);
  assert.deepEqual([problemOf(OUTCOME), isMomentary(OUTCOME)], [undefined, false]);
});

test("a refusal has its problem, and says whether it is unrelated to the scenarios", () => {
  const refusal = { problem: "a run is in progress" };
  assert.deepEqual([problemOf(refusal), isMomentary(refusal)], ["a run is in progress", false]);
  assert.equal(isMomentary({ ...refusal, momentary: true }), true);
  assert.deepEqual([outcomeOf(refusal), recordedIn(refusal), picturesOf(refusal)], [undefined, undefined, []]);
});

test("what has another form is neither", () => {
  for (const answer of [undefined, null, [], {}, { problem: 1 }, { ...OUTCOME, pictures: [1] }, { momentary: true }]) {
    assert.deepEqual([outcomeOf(answer), problemOf(answer), isMomentary(answer), picturesOf(answer)], [undefined, undefined, false, []]);
  }
});
