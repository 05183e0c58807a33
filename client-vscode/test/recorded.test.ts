// Answers that the real server has given, as the extension reads them. `tests/lsp/recorded_answers.py` records them.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import * as forms from "../src/answers/validators.mjs";
import { summaryOf as comparisonSummary } from "../src/panels/comparison/answer";
import { remark as graphRemark } from "../src/panels/graph/answer";
import { isHistory, marginOf, rateOf, remarkOf, summaryOf } from "../src/panels/history/answer";
import { ageOf, firstClause, titleOf } from "../src/panels/replay/answer";
import { outcome } from "../src/panels/runs";
import { notes, remark, still } from "../src/panels/scene/answer";
import { problemOf } from "../src/testing/answers";
import { showResults } from "../src/testing/results";
import { TestTree } from "../src/testing/tree";
import { factory, Nodes, recorded } from "./testing.kit";

const FOLDER = join(process.cwd(), "test", "recorded");
const FORMS: Readonly<Record<string, (value: unknown) => boolean>> = {
  "tests-of-file": forms.isListing,
  "tests-of-variant": forms.isListing,
  compare: forms.isComparison,
  estimate: forms.isRunEstimate,
  graph: forms.isGraphPicture,
  history: forms.isClauseHistory,
  preview: forms.isPreview,
  runanswer: forms.isRunAnswer,
  runs: forms.isStoredRuns,
  scene: forms.isScenePicture,
  templates: forms.isTemplates,
  testresults: forms.isFoundResults,
  tests: forms.isListing,
  trace: forms.isTrace,
};

function answer<T>(name: string, is: (value: unknown) => value is T): T {
  const value: unknown = JSON.parse(readFileSync(join(FOLDER, `${name}.json`), "utf8"));
  assert.ok(is(value), `${name} has another form`);
  return value;
}

test("each answer of the server has the form that the extension expects", () => {
  assert.deepEqual(readdirSync(FOLDER).sort(), Object.keys(FORMS).map((name) => `${name}.json`).sort());
  for (const [name, is] of Object.entries(FORMS)) {
    assert.ok(is(JSON.parse(readFileSync(join(FOLDER, `${name}.json`), "utf8"))), name);
  }
});

test("the Testing view lists the tests of the server, and shows its results at them", async () => {
  const listings = ["tests", "tests-of-file", "tests-of-variant"].map((name) => answer(name, forms.isListing));
  const [files, ofFile, ofVariant] = listings;
  assert.ok(files !== undefined && ofFile !== undefined && ofVariant !== undefined);
  const roots = new Nodes();
  const tree = new TestTree(roots, factory, async ({ uri, variant }) => Promise.resolve(variant !== undefined ? ofVariant : uri !== undefined ? ofFile : files), () => undefined);
  await tree.expand(undefined);
  const story = [...roots].map(([, item]) => item).find(({ label }) => label === "tidy-bench");
  assert.ok(story);
  const variant = [...story.children].map(([, item]) => item)[0];
  assert.ok(variant);
  assert.equal(variant.label, "part-to-bin");
  await tree.expand(variant);
  assert.equal(variant.children.size, 4);
  const found = answer("testresults", forms.isFoundResults);
  const { calls, sink } = recorded();
  const { left } = await showResults(tree, found.scenarios, sink);
  assert.deepEqual(left, []);
  assert.equal(calls.length, 10, calls.join("\n"));
  assert.equal(calls.filter((call) => call.includes("pass")).length, 4, calls.join("\n"));
});

test("two runs are compared, and a clause has its history", () => {
  const comparison = answer("compare", forms.isComparison);
  assert.equal(comparisonSummary(comparison), "0 flipped, 2 the same");
  const history = answer("history", isHistory);
  assert.equal(summaryOf(history), "holds in 2 of 2 runs");
  assert.deepEqual(history.runs.map((run) => [rateOf(run), marginOf(run), remarkOf(run)]), [["2/2", "+15.8 mm", ""], ["2/2", "+15.8 mm", ""]]);
  const { runs } = answer("runs", forms.isStoredRuns);
  assert.deepEqual(runs.map(outcome), ["2 unknown", "2 unknown"]);
});

test("a replay has a title, its first clause to look at, and frames for each body", () => {
  const trace = answer("trace", forms.isTrace);
  assert.equal(titleOf(trace.scenario), "part-to-bin 1");
  assert.equal(ageOf(trace.clauses), "");
  assert.equal(trace.clauses[firstClause(trace.clauses)]?.name, "goal-untouched");
  assert.deepEqual(trace.frames.poses.shape, [trace.frames.times.shape[0], trace.frames.bodies.length, 7]);
});

test("a scene and a graph are drawn without remarks on errors", () => {
  const scene = answer("scene", forms.isScenePicture);
  assert.equal(remark(scene), "");
  const [drawn] = scene.scenes;
  assert.ok(drawn !== undefined);
  assert.deepEqual(notes(drawn), ["At a sampled pose: cube0, cube1."]);
  assert.equal(still(drawn).bodies.length, drawn.bodies.length);
  assert.equal(graphRemark(answer("graph", forms.isGraphPicture)), "");
});

test("a run that selects nothing has a problem, and an estimate its words", () => {
  assert.equal(problemOf(answer("runanswer", forms.isRunAnswer)), "no scenario fits the selection");
  const estimate = answer("estimate", forms.isRunEstimate);
  assert.ok("words" in estimate);
  assert.equal(estimate.words, "2 executions, about 1 s");
});
