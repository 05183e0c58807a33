import assert from "node:assert/strict";
import { test } from "node:test";
import type { RunMessage } from "../src/runs/messages";
import { RunFollower } from "../src/testing/follower";
import { type FoundScenario, showResults } from "../src/testing/results";
import { fileRuns } from "../src/testing/selection";
import { message } from "./messages.kit";
import { FILE, World, at, recorded, words } from "./testing.kit";
import type { ListedTest } from "../src/testing/listing";

const MODEL = `${FILE}x`;

const execution = (name: string): ListedTest => ({
  kind: "execution",
  id: `x:${name}`,
  name,
  detail: "tidy.fetch · 3 scenarios",
  variant: "t:fetch",
  count: 3,
  digest: "1",
  place: at(4, MODEL),
  variation: at(12),
  tests: [],
});

/** The world with a file that executes one variant in two ways. */
function executing(): World {
  const world = new World();
  const tests = [execution("by-catalog"), execution("by-ours")];
  world.files = [FILE, MODEL];
  world.others[MODEL] = [{ kind: "file", id: MODEL, name: "fetch.bddx", detail: "2 executions", place: null, tests }];
  return world;
}

test("executions are listed below their file, their scenarios as those of the variant", async () => {
  const world = executing();
  await world.tree.expand(undefined);
  assert.deepEqual(world.labels(), ["tidy", "fetch.bddx"]);
  const item = world.item("fetch.bddx", "by-ours");
  assert.ok(item.canResolveChildren);
  await world.tree.expand(item);
  assert.deepEqual(world.labels(item), ["part = cube1", "part = cube2", "part = cube3"]);
  assert.equal(world.item("tidy", "fetch").children.size, 0);
  // A clause in the text offers to run the scenarios as they are.
  assert.equal(world.item("fetch.bddx", "by-ours", "part = cube1", "Then held").place, null);
});

test("executions run separately, the file runs all of them", async () => {
  const world = executing();
  await world.tree.expand(undefined);
  await world.tree.expand(world.item("fetch.bddx", "by-ours"));
  const runs = (...path: string[]) => fileRuns(world.roots, (item) => world.tree.about(item), [world.item(...path)], []);
  const [one, two] = ["x:by-catalog", "x:by-ours"].map((name) => ({ variant: "t:fetch", execution: name }));
  assert.deepEqual(runs("fetch.bddx"), [{ uri: MODEL, only: [one, two] }]);
  assert.deepEqual(runs("fetch.bddx", "by-ours", "part = cube2"), [{ uri: MODEL, only: [{ ...two, variations: [2] }] }]);
  assert.deepEqual(runs("tidy", "fetch"), [{ uri: FILE, only: [{ variant: "t:fetch" }] }]);
});

const begun = { name: "fetch", values: "part = cube1", source: at(9) };
const judged = { unit: "m", at: 1, ...words("held", 0) };

test("a clause of an execution that is repeated is as good as its worst verdict", async () => {
  const world = executing();
  const { calls, sink } = recorded();
  const follower = new RunFollower(world.tree, sink, "fetch.bddx", () => 0);
  const verdicts = [0.01, -0.02, 0.03].flatMap((robustness, index): RunMessage[] => [
    message("ScenarioStarted", { ...begun, index, execution: "x:by-ours" }),
    message("ClauseStarted", { index, ...words("held", 0) }),
    message("ClauseJudged", {
      ...judged, index, robustness, verdict: robustness < 0 ? "violated" : "holds", failure: robustness < 0 ? "pushed (violated)" : "",
    }),
  ]);
  for (const verdict of verdicts) {
    follower.take({ run: "1", uri: MODEL, message: verdict });
  }
  await follower.settled();
  const failed = "failed part = cube1 / Then held";
  const why = "pushed (violated) [part = cube1]";
  assert.deepEqual(calls, [
    "started part = cube1 / Then held",
    "passed part = cube1 / Then held 0",
    `${failed} ${why} · 1 of 2 hold @3`,
    `${failed} ${why} · 2 of 3 hold @3`,
  ]);
  const item = world.item("fetch.bddx", "by-ours", "part = cube1", "Then held");
  assert.equal(item.description, "2/3 hold · −20.0 mm · at 1.00 s · cube is held");
  assert.deepEqual(world.labels(), ["fetch.bddx"], "the variant as it is was not run");
});

test("kept results of executions are theirs, the worst of several repetitions", async () => {
  const world = executing();
  const { calls, sink } = recorded();
  const clause = { clause: "t:held", position: null, sentence: "", margin: "", stale: false };
  const result = (execution: string, verdict: "holds" | "violated"): FoundScenario => ({
    uri: MODEL, variant: "t:fetch", execution, variation: 1, values: "", seconds: null, stale: false,
    clauses: [{ ...clause, verdict, said: verdict, failure: verdict, because: null }],
  });
  const results = [result("x:by-ours", "violated"), result("x:by-ours", "holds"), result("x:by-catalog", "holds")];
  await showResults(world.tree, [...results, result("x:gone", "violated")], sink);
  assert.deepEqual(calls, [
    "failed part = cube1 / Then held violated @3",
    "failed part = cube1 / Then held violated · 1 of 2 hold @3",
    "passed part = cube1 / Then held ?",
  ]);
  assert.equal(world.item("fetch.bddx", "by-catalog", "part = cube1", "Then held").description, "cube is held");
});
