import assert from "node:assert/strict";
import { test } from "node:test";
import { isListing } from "../src/testing/listing";
import { outcomeOf } from "../src/testing/outcomes";
import { fileRuns } from "../src/testing/selection";
import { RunFollower } from "../src/testing/follower";
import { isFoundResults, showResults } from "../src/testing/results";
import type { Because } from "../src/runs/messages";
import { message } from "./messages.kit";
import { FILE, Node, SCENE, World, at, recorded, story, variant, words } from "./testing.kit";

test("stories and variants are listed first, scenarios when they are asked for", async () => {
  const world = new World();
  await world.tree.expand(undefined);
  assert.deepEqual(world.labels(), ["tidy"]);
  assert.equal(world.item("tidy").description, "fetch.bdd · order");
  assert.deepEqual(world.labels(world.item("tidy")), ["fetch", "sort"]);
  assert.deepEqual(world.asked, ["files", FILE]);
  const fetch = world.item("tidy", "fetch");
  assert.ok(fetch.canResolveChildren);
  await world.tree.expand(fetch);
  assert.deepEqual(world.labels(fetch), ["part = cube1", "part = cube2", "part = cube3"]);
  assert.deepEqual(world.labels(world.item("tidy", "fetch", "part = cube2")), ["Then held", "Then placed"]);
});

test("a scenario without its own row is placed at the list of values", async () => {
  const world = new World();
  await world.tree.expand(undefined);
  await world.tree.expand(world.item("tidy", "fetch"));
  assert.deepEqual(world.item("tidy", "fetch", "part = cube1").place, at(12));
});

test("of a shown file only variants with few scenarios are listed unasked", async () => {
  const world = new World();
  await world.tree.load(FILE);
  await world.tree.expandSmall(FILE);
  assert.equal(world.item("tidy", "fetch").children.size, 3);
  assert.equal(world.item("tidy", "sort").children.size, 0);
});

test("an edit keeps the items, marks outdated ones, and removes deleted ones", async () => {
  const world = new World();
  await world.tree.load(FILE);
  await world.tree.expandSmall(FILE);
  const before = world.item("tidy", "fetch");
  world.stories = [story(variant("fetch", 2, "2"))];
  await world.tree.load(FILE);
  await world.tree.expandSmall(FILE);
  assert.equal(world.item("tidy", "fetch"), before);
  assert.deepEqual(world.outdated, ["fetch"]);
  assert.equal(before.children.size, 2);
  assert.deepEqual(world.labels(world.item("tidy")), ["fetch"]);
});

test("an error is shown at the variant and keeps the listed scenarios", async () => {
  const world = new World();
  await world.tree.load(FILE);
  const fetch = world.item("tidy", "fetch");
  await world.tree.expand(fetch);
  world.problem = "the model has errors";
  await world.tree.expand(fetch);
  assert.equal(fetch.problem, "the model has errors");
  assert.equal(fetch.children.size, 3);
  world.problem = null;
  await world.tree.expand(fetch);
  assert.equal(fetch.problem, undefined);
});

test("of many scenarios the first are listed, as many again with each step further, with their kept results", async () => {
  const world = new World();
  const { calls, sink } = recorded();
  await world.tree.load(FILE);
  const item = world.item("tidy", "sort");
  const kept = { ...found, variant: "t:sort", variation: 500, clauses: [{ ...held, clause: "t:held", position: null, stale: false }] };
  assert.deepEqual(await showResults(world.tree, [kept], sink), { outdated: [], left: [kept] });
  assert.deepEqual(world.labels(item).slice(-2), ["part = cube200", "More: 201 to 400"]);
  await world.tree.expand(world.item("tidy", "sort", "More: 201 to 400"));
  assert.equal(item.children.size, 401);
  await world.tree.expand(item);
  assert.equal(item.children.size, 401, "an edit lists as many as were listed");
  await world.tree.expand(world.item("tidy", "sort", "More: 401 to 800"));
  await showResults(world.tree, [kept], sink);
  assert.deepEqual(calls, ["passed part = cube500 / Then held ?"]);
  await world.tree.expand(world.item("tidy", "sort", "More: 801 to 1,000"));
  assert.equal(world.labels(item).at(-1), "part = cube1000");
  assert.equal(item.children.size, 1000);
});

test("files that are gone take their stories along", async () => {
  const world = new World();
  await world.tree.expand(undefined);
  assert.deepEqual(world.tree.dependents(SCENE), [FILE]);
  world.files = [];
  await world.tree.expand(undefined);
  assert.deepEqual(world.labels(), []);
  assert.deepEqual(world.tree.dependents(SCENE), []);
});

async function chosen(include: string[][] | undefined, exclude: string[][] = []) {
  const world = new World();
  await world.tree.expand(undefined);
  await world.tree.expand(world.item("tidy", "fetch"));
  const items = (paths: string[][]) => paths.map((path) => world.item(...path));
  const about = (item: Node) => world.tree.about(item);
  return fileRuns(world.roots, about, include && items(include), items(exclude));
}

test("after a run the pass rates of its file and of the stories that it imports are listed again", async () => {
  const world = new World();
  const execution = `${FILE}x`;
  world.files = [FILE, execution];
  await world.tree.expand(undefined);
  world.stories = [story({ ...variant("fetch", 3), detail: "? 2 of 3 executed, 2 passed" })];
  world.asked.length = 0;
  await world.tree.refresh(execution);
  assert.deepEqual(world.asked, [execution, FILE]);
  assert.equal(world.item("tidy", "fetch").description, "? 2 of 3 executed, 2 passed");
});

test("any selection becomes runs of whole variants or of numbers", async () => {
  const whole = [{ variant: "t:fetch" }, { variant: "t:sort" }];
  assert.deepEqual(await chosen(undefined), [{ uri: FILE, only: whole }]);
  assert.deepEqual(await chosen([["tidy"]]), [{ uri: FILE, only: whole }]);
  assert.deepEqual(await chosen([["tidy", "fetch"]]), [{ uri: FILE, only: [{ variant: "t:fetch" }] }]);
  assert.deepEqual(
    await chosen([
      ["tidy", "fetch", "part = cube3"],
      ["tidy", "fetch", "part = cube1", "Then held"],
      ["tidy", "fetch", "part = cube1", "Then placed"],
    ]),
    [{ uri: FILE, only: [{ variant: "t:fetch", variations: [1, 3] }] }],
  );
});

test("excluded tests are not run", async () => {
  assert.deepEqual(await chosen([["tidy"]], [["tidy", "sort"]]), [{ uri: FILE, only: [{ variant: "t:fetch" }] }]);
  assert.deepEqual(await chosen(undefined, [["tidy"]]), []);
  assert.deepEqual(await chosen([["tidy", "fetch"]], [["tidy", "fetch", "part = cube2"]]), [
    { uri: FILE, only: [{ variant: "t:fetch", variations: [1, 3] }] },
  ]);
  const clause = ["tidy", "fetch", "part = cube2", "Then held"];
  assert.deepEqual(await chosen([["tidy", "fetch"]], [clause]), [{ uri: FILE, only: [{ variant: "t:fetch" }] }]);
});

const verdict = { robustness: -0.012, unit: "m", at: 3.2, reason: "the bin was pushed", failure: "the bin was pushed (violated)" };

test("a violated clause fails with its reason first, and the scenario's values", () => {
  assert.deepEqual(outcomeOf({ ...verdict, verdict: "violated" }, "part = cube1"), {
    state: "failed",
    note: "the bin was pushed · −12.0 mm · at 3.20 s",
    failure: { text: "the bin was pushed (violated) [part = cube1]" },
  });
});

test("an unknown clause has an error with its reason, not a failure", () => {
  const unknown = { ...verdict, verdict: "unknown", robustness: null, at: null, reason: "timed out", failure: "timed out (unknown)" } as const;
  assert.deepEqual(outcomeOf(unknown, ""), {
    state: "errored",
    note: "timed out",
    failure: { text: "timed out (unknown)" },
  });
});

test("a clause that could not have been violated says so though it holds", () => {
  const holds = { ...verdict, verdict: "holds", robustness: 0.031, reason: "", failure: "", vacuous: "nothing ever moved" } as const;
  assert.deepEqual(outcomeOf(holds, ""), { state: "passed", note: "+31.0 mm · vacuous: nothing ever moved" });
});

test("a run shows clauses of unopened files, and ends", async () => {
  const world = new World();
  let clock = 0;
  const { calls, sink } = recorded();
  const follower = new RunFollower<Node>(world.tree, sink, "fetch.bdd", () => (clock += 10));
  const judged = { robustness: 0.01, unit: "m", at: 1 };
  const because: Because = { clause: "t:placed", position: 1, words: "unknown because of placed" };
  const unknown = { verdict: "unknown", failure: "never held (unknown)" } as const;
  for (const said of [
    message("RunStarted"),
    message("ScenarioStarted", { values: "part = cube2", variation: 2, source: at(9) }),
    message("ClauseStarted", words("held", 0)),
    message("ClauseJudged", { ...judged, ...words("held", 0) }),
    message("ClauseStarted", { line: 8, ...words("placed", 1) }),
    message("ClauseJudged", { ...judged, verdict: "violated", robustness: -0.02, failure: "violated by −20 mm", ...words("placed", 1) }),
    message("ClauseJudged", { ...unknown, because, ...words("moved", 2) }),
    message("ClauseJudged", { ...unknown, because: { ...because, position: 0 }, ...words("rested", 3) }),
  ]) {
    follower.take({ run: "1", uri: FILE, message: said });
  }
  await follower.interrupt("The server stopped.");
  assert.deepEqual(calls, [
    "started part = cube2 / Then held",
    "passed part = cube2 / Then held 10",
    "started part = cube2 / Then placed",
    "failed part = cube2 / Then placed violated by −20 mm [part = cube2] @3",
    "skipped part = cube2 / Then moved",
    "skipped part = cube2 / Then rested",
    "end",
  ]);
  // Listing the scenarios afterwards keeps the run's results.
  const item = world.item("tidy", "fetch", "part = cube2", "Then placed");
  await world.tree.expand(world.item("tidy", "fetch"));
  assert.equal(world.item("tidy", "fetch", "part = cube2", "Then placed"), item);
  assert.equal(item.description, "−20.0 mm · at 1.00 s · cube is placed");
});

test("a clause that a cancelled run left open gets no result", async () => {
  const world = new World();
  const { calls, sink } = recorded();
  const follower = new RunFollower<Node>(world.tree, sink, "fetch.bdd", () => 0);
  const open = { verdict: "unknown", reason: "the run was cancelled", failure: "the run was cancelled (unknown)", cancelled: true } as const;
  for (const said of [
    message("ScenarioStarted", { variation: 2, source: at(9) }),
    message("ClauseJudged", { ...open, ...words("held", 0) }),
  ]) {
    follower.take({ run: "1", uri: FILE, message: said });
  }
  await follower.settled();
  assert.deepEqual(calls, []);
});

test("a scenario that a cancelled run left open has not passed, those that ended have", async () => {
  const world = new World();
  const { calls, sink } = recorded();
  const follower = new RunFollower<Node>(world.tree, sink, "fetch.bdd", () => 0);
  const judged = { robustness: 0.01, unit: "m", at: 1 };
  const open = { verdict: "unknown", failure: "the run was cancelled (unknown)", cancelled: true } as const;
  // Scenario 2 has ended, of scenario 3 one of two repetitions, and the others have not.
  const scenarios = [2, 3, 3, 1].map((variation, index) => [
    message("ScenarioStarted", { index, variation, values: `part = cube${variation}`, source: at(9) }),
    message("ClauseJudged", { index, ...judged, ...words("held", 0) }),
    ...(index < 2 ? [message("ScenarioFinished", { index })] : [message("ClauseJudged", { index, ...open, ...words("placed", 1) })]),
  ]);
  for (const said of scenarios.flat()) {
    follower.take({ run: "1", uri: FILE, message: said });
  }
  await follower.interrupt("");
  assert.deepEqual(calls, [
    "passed part = cube2 / Then held 0",
    "passed part = cube3 / Then held 0",
    "passed part = cube3 / Then held 0",
    "passed part = cube1 / Then held 0",
    "skipped part = cube1 / Then held",
    "end",
  ]);
});

test("a refused run shows the reason at the requested tests", async () => {
  const world = new World();
  await world.tree.load(FILE);
  const { calls, sink } = recorded();
  const follower = new RunFollower<Node>(world.tree, sink, "fetch.bdd", () => 0);
  const refused = (variations?: number[]) => {
    const wanted = world.tree.wanted(FILE, { variant: "t:fetch", ...(variations && { variations }) });
    follower.refuse(wanted, "a run is in progress");
  };
  refused();
  await world.tree.expand(world.item("tidy", "fetch"));
  refused([3]);
  assert.deepEqual(calls, ["errored tidy / fetch a run is in progress", "errored fetch / part = cube3 a run is in progress"]);
});

const found = { uri: FILE, variant: "t:fetch", variation: 2, values: "part = cube2", seconds: null, stale: false };
const held = { clause: null, position: 0, sentence: "cube is held", verdict: "holds", margin: "", said: "✔", failure: "", because: null } as const;

test("imported results are shown by position, with their words and their share of the time", async () => {
  const world = new World();
  const { calls, sink } = recorded();
  const PUSHED = "pushed (violated by −3.0 mm at 2.00 s)";
  const placed = { ...held, position: 1, verdict: "violated", margin: "−3.0 mm", said: "✗ −3.0 mm at 2.00 s: pushed", failure: PUSHED } as const;
  const clauses = [held, placed].map((clause) => ({ ...clause, stale: false }));
  const shown = await showResults(world.tree, [{ ...found, seconds: 1, clauses }], sink);
  assert.deepEqual(shown, { outdated: [], left: [] });
  assert.deepEqual(calls, [
    "passed part = cube2 / Then held 500",
    `failed part = cube2 / Then placed ${PUSHED} [part = cube2] @3`,
  ]);
  assert.equal(world.item("tidy", "fetch", "part = cube2", "Then placed").description, "−3.0 mm · cube is placed");
});

test("a clause that is unknown because of one that failed is skipped, so that its scenario has failed", async () => {
  const world = new World();
  const { calls, sink } = recorded();
  const failed = { ...held, clause: "t:held", verdict: "violated", failure: "dropped (violated)", stale: false } as const;
  const because = { clause: "t:held", position: 0, words: "unknown because of held" };
  const unknown = { ...failed, clause: "t:placed", position: 1, verdict: "unknown", failure: "dropped (unknown)", because } as const;
  await showResults(world.tree, [{ ...found, clauses: [failed, unknown] }], sink);
  const byName = [failed, unknown].map((one) => ({ ...one, position: null, because: one.because && { ...because, position: null } }));
  await showResults(world.tree, [{ ...found, clauses: byName }], sink);
  const shown = ["failed part = cube2 / Then held dropped (violated) [part = cube2] @3", "skipped part = cube2 / Then placed"];
  assert.deepEqual(calls, [...shown, ...shown]);
  assert.equal(world.item("tidy", "fetch", "part = cube2", "Then placed").description, "unknown because of held · cube is placed");
  calls.length = 0;
  // Without its cause it has the error itself: a scenario of skipped clauses would have passed.
  await showResults(world.tree, [{ ...found, clauses: [{ ...failed, verdict: "holds" }, unknown] }], sink);
  assert.match(calls[1] ?? "", /^errored .*Then placed dropped \(unknown\)/);
});

test("kept results are shown by IRI; stale ones are told, and variants that are gone are passed over", async () => {
  const world = new World();
  const { calls, sink } = recorded();
  const unknown = { ...held, clause: "t:placed", position: null, verdict: "unknown", said: "? unknown: timed out", failure: "timed out (unknown)", stale: true } as const;
  const gone = { ...found, variant: "t:gone", clauses: [unknown] };
  const { outdated } = await showResults(world.tree, [{ ...found, clauses: [unknown] }, gone], sink);
  assert.deepEqual(calls, ["errored part = cube2 / Then placed timed out (unknown) [part = cube2]"]);
  assert.deepEqual(outdated, [world.item("tidy", "fetch", "part = cube2", "Then placed")]);
});

test("an answer of another shape is not taken for results", () => {
  assert.ok(isFoundResults({ problem: null, left: 0, scenarios: [] }));
  assert.ok(!isFoundResults({ problem: null, scenarios: [] }));
});

test("an answer of another shape is not taken for a listing", () => {
  assert.ok(isListing({ problem: null, files: [FILE], tests: [story(variant("fetch", 3))] }));
  for (const wrong of [undefined, {}, { problem: null, files: [1], tests: [] }, { problem: null, files: [], tests: [{}] }]) {
    assert.ok(!isListing(wrong), JSON.stringify(wrong));
  }
});
