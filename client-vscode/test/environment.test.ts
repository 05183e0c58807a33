import assert from "node:assert/strict";
import { test } from "node:test";
import { answerOf } from "../src/environment";

async function asked<Answer>(ask: () => PromiseLike<Answer> | Answer, limit?: number) {
  const warnings: string[] = [];
  const answer = await answerOf("The stub failed", ask, (message) => warnings.push(message), limit);
  return { answer, warnings };
}

test("an answer is passed on without a word", async () => {
  assert.deepEqual(await asked(() => Promise.resolve("/usr/bin/python3")), { answer: "/usr/bin/python3", warnings: [] });
});

test("an extension that rejects or throws is ignored, and the log has the reason", async () => {
  const told = ["The stub failed: no such environment. It is ignored."];
  const error = new Error("no such environment");
  assert.deepEqual(await asked(() => Promise.reject(error)), { answer: undefined, warnings: told });
  const { answer, warnings } = await asked(() => {
    throw error;
  });
  assert.deepEqual({ answer, warnings }, { answer: undefined, warnings: told });
});

test("an extension that never answers is ignored after the limit", async () => {
  const { answer, warnings } = await asked(() => new Promise<string>(() => undefined), 20);
  assert.equal(answer, undefined);
  assert.deepEqual(warnings, ["The stub failed: there was no answer within 0.02 s. It is ignored."]);
});
