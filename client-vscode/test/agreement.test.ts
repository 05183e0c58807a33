// A scenario has failed, has an error or has passed: the Testing view, live and from stored results, the summary of the run
// and the states of its clauses agree, whatever the causes are and in whatever order they are judged.
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Because } from "../src/runs/messages";
import { RunReport } from "../src/runs/report";
import { type Sink, RunFollower } from "../src/testing/follower";
import { showResults } from "../src/testing/results";
import { message } from "./messages.kit";
import { FILE, Node, World, at, recorded, words } from "./testing.kit";

type Verdict = "holds" | "violated" | "unknown";
type State = "passed" | "failed" | "errored" | "skipped";
interface Case {
  readonly clauses: readonly (readonly [Verdict, because?: number])[];
  readonly outcome: Exclude<State, "skipped">;
  readonly states: readonly State[];
}

const CASES: Readonly<Record<string, Case>> = {
  "nothing fails": { clauses: [["holds"], ["holds"]], outcome: "passed", states: ["passed", "passed"] },
  "a margin is negative": { clauses: [["holds"], ["violated"]], outcome: "failed", states: ["passed", "failed"] },
  "the agent cannot reach, and so nothing happens": {
    clauses: [["violated"], ["unknown", 0], ["unknown", 0]], outcome: "failed", states: ["failed", "skipped", "skipped"],
  },
  "code of a step fails": { clauses: [["holds"], ["unknown"]], outcome: "errored", states: ["passed", "errored"] },
  "the scene cannot be built": {
    clauses: [["unknown"], ["unknown", 0], ["unknown", 0]], outcome: "errored", states: ["errored", "skipped", "skipped"],
  },
  "no step judges a text, and another clause is violated": {
    clauses: [["unknown"], ["violated"]], outcome: "failed", states: ["skipped", "failed"],
  },
  "a clause is violated, and then the run times out": {
    clauses: [["violated"], ["unknown"]], outcome: "failed", states: ["failed", "skipped"],
  },
  "two errors of their own": { clauses: [["unknown"], ["unknown"]], outcome: "errored", states: ["errored", "errored"] },
};

/** The state that the editor gives an item: the worst of those below it, and an error is worse than a failure. */
function rolledUp(states: readonly State[]): State {
  return (["errored", "failed", "passed"] as const).find((state) => states.includes(state)) ?? "skipped";
}

/** The states of clauses in the order of the tree. Like the editor, it never takes back a worse state. */
function shown(): { readonly sink: Sink<Node>; readonly states: () => State[] } {
  const found = new Map<Node, State>();
  const severity: readonly State[] = ["passed", "skipped", "failed", "errored"];
  const set = (state: State) => (item: Node) => {
    const before = found.get(item);
    found.set(item, before !== undefined && severity.indexOf(before) > severity.indexOf(state) ? before : state);
  };
  const sink = { ...recorded().sink, passed: set("passed"), failed: set("failed"), errored: set("errored"), skipped: set("skipped") };
  return { sink, states: () => [...found].sort(([one], [other]) => indexOf(one) - indexOf(other)).map(([, state]) => state) };
}

function indexOf(item: Node): number {
  return [...item.parent?.children ?? []].findIndex(([, one]) => one === item);
}

const name = (position: number) => `clause-${position}`;
const causeOf = (position: number | undefined): Because | null =>
  position === undefined ? null : { clause: `t:${name(position)}`, position, words: `unknown because of ${name(position)}` };

for (const [cause, { clauses, outcome, states }] of Object.entries(CASES)) {
  const failure = (verdict: Verdict) => (verdict === "holds" ? "" : `${cause} (${verdict})`);

  test(`${cause}: the scenario has ${outcome} in a run`, async () => {
    const view = shown();
    const world = new World();
    const follower = new RunFollower<Node>(world.tree, view.sink, "fetch.bdd", () => 0);
    const report = new RunReport("fetch.bdd");
    const messages = [
      message("RunStarted"),
      message("ScenarioStarted", { values: "part = cube2", variation: 2, source: at(9) }),
      ...clauses.map(([verdict, because], position) =>
        message("ClauseJudged", { ...words(name(position), position), verdict, failure: failure(verdict), because: causeOf(because) })),
      message("ScenarioFinished"),
    ];
    for (const said of messages) {
      follower.take({ run: "1", uri: FILE, message: said });
      report.add(said);
    }
    await follower.settled();
    assert.deepEqual(view.states(), states);
    assert.equal(rolledUp(view.states()), outcome);
    assert.equal(report.tally[outcome], 1);
    await follower.interrupt("");
    assert.deepEqual(view.states(), states);
  });

  test(`${cause}: the scenario has ${outcome} in stored results`, async () => {
    const view = shown();
    const found = { uri: FILE, variant: "t:fetch", variation: 2, values: "part = cube2", seconds: null, stale: false };
    await showResults(new World().tree, [{
      ...found,
      clauses: clauses.map(([verdict, because], position) => ({
        clause: `t:${name(position)}`, position, sentence: name(position), verdict, margin: "", said: "", failure: failure(verdict),
        because: causeOf(because), stale: false,
      })),
    }], view.sink);
    assert.deepEqual(view.states(), states);
    assert.equal(rolledUp(view.states()), outcome);
  });
}

test("an unknown clause of an execution that never ended has an error", async () => {
  const view = shown();
  const follower = new RunFollower<Node>(new World().tree, view.sink, "fetch.bdd", () => 0);
  follower.take({ run: "1", uri: FILE, message: message("ScenarioStarted", { variation: 2, source: at(9) }) });
  const lost = message("ClauseJudged", { ...words("held", 0), verdict: "unknown", failure: "timed out (unknown)" });
  follower.take({ run: "1", uri: FILE, message: lost });
  await follower.settled();
  assert.deepEqual(view.states(), []);
  await follower.interrupt("The server stopped.");
  assert.deepEqual(view.states(), ["errored"]);
});
