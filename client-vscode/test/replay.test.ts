import assert from "node:assert/strict";
import { test } from "node:test";
import { type Clause, type PackedArray, type Part, ageOf, firstClause, isTrace, titleOf } from "../src/panels/replay/answer";
import { clauseOf, recordingOf } from "../src/panels/replay/request";
import { isRuns, outcome } from "../src/panels/runs";
import { signed } from "../src/quantity";
import { followable } from "../webviews/replay/followed";
import { Pressed } from "../webviews/replay/pressed";
import { Clock } from "../webviews/replay/clock";
import { extent, points } from "../webviews/replay/margins";
import { Motion } from "../webviews/replay/motion";
import { lanes, scale, ticks } from "../webviews/replay/scale";
import { apart } from "../webviews/stage/tags";

const packed = (values: number[], ...shape: number[]): PackedArray => ({
  type: "float32",
  shape,
  data: Buffer.from(new Float32Array(values).buffer).toString("base64"),
});
const PART: Part = { start: 1, end: 2, reason: "", unit: "m", negated: false, times: [0, 1], margins: [0.5, -0.25] };
const clause = (name: string, verdict: Clause["verdict"], at: number | null): Clause => ({
  iri: `https://example.org/${name}`,
  name,
  role: "then",
  sentence: name,
  verdict,
  robustness: null,
  unit: "",
  at,
  worst_at: at,
  reason: "",
  vacuous: "",
  source: null,
  parts: [],
});

test("a body between two frames is between its two places, and turns the shorter way", () => {
  const quarter = Math.SQRT1_2;
  const poses = [0, 0, 0, 1, 0, 0, 0, 2, 4, 6, -quarter, 0, 0, -quarter];
  const motion = new Motion({ frames: { times: packed([0, 2], 2), bodies: [7], poses: packed(poses, 2, 1, 7) } });
  const at = (time: number) => {
    const told: [number, readonly number[]][] = [];
    motion.at(time, (body, pose) => told.push([body, pose]));
    const [[body, pose] = [0, []]] = told;
    assert.equal(body, 7);
    return pose.map((value) => Math.round(value * 1e4) / 1e4);
  };
  const half = [Math.cos(Math.PI / 8), Math.sin(Math.PI / 8)].map((value) => Math.round(value * 1e4) / 1e4);
  assert.deepEqual(at(1), [1, 2, 3, half[0], 0, 0, half[1]]);
  assert.deepEqual(at(-1), [0, 0, 0, 1, 0, 0, 0]);
  assert.deepEqual(at(9).slice(0, 3), [2, 4, 6]);
});

test("the clock stops at the end and restarts from the beginning", () => {
  let changes = 0;
  const clock = new Clock(2, () => (changes += 1));
  clock.advance(1);
  assert.equal(clock.time, 0, "it does not run by itself");
  clock.toggle();
  clock.speed = 0.5;
  clock.advance(1);
  assert.equal(clock.time, 0.5);
  clock.advance(10);
  assert.deepEqual([clock.time, clock.playing], [2, false]);
  clock.toggle();
  assert.deepEqual([clock.time, clock.playing], [0, true]);
  clock.seek(-3);
  assert.equal(clock.time, 0);
  assert.ok(changes >= 4);
});

test("a scale leads there and back", () => {
  const along = scale(0, 8, 10, 90);
  assert.equal(along(2), 30);
  assert.equal(along.back(30), 2);
});

test("ticks are round numbers within their range", () => {
  assert.deepEqual(ticks(0, 6.27, 6), [0, 2, 4, 6]);
  assert.deepEqual(ticks(0, 1, 10), [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1]);
  assert.deepEqual(ticks(-0.11, 0.04, 3), [-0.1, -0.05, 0]);
  assert.deepEqual(ticks(3, 3, 5), [3]);
});

test("overlapping labels get separate lanes", () => {
  const widths = [0, 10, 25, 70].map((start) => ({ start, width: 30 }));
  assert.deepEqual(lanes(widths), [0, 1, 2, 0]);
});

test("overlapping names in the scene are stacked", () => {
  const tag = (x: number, y: number) => ({ x, y, width: 40, height: 10 });
  assert.deepEqual(apart([tag(0, 50), tag(30, 52), tag(90, 52)]), [42, 52, 52]);
  assert.deepEqual(apart([tag(0, 38), tag(0, 50), tag(0, 45)]), [30, 50, 40]);
  assert.deepEqual(apart([tag(0, 30), tag(0, 20)]), [30, 20]);
});

test("a margin is drawn in the sense of its clause", () => {
  assert.deepEqual(points(PART), [[0, 0.5], [1, -0.25]]);
  assert.deepEqual(points({ ...PART, negated: true }), [[0, -0.5], [1, 0.25]]);
  const [low, high] = extent([0.5, 1]);
  assert.ok(low < 0 && high > 1, "zero and all values have room");
  assert.deepEqual([signed(-0.0362, "m"), signed(1.5, "m"), signed(0.25, "rad")], ["−36.2 mm", "+1.50 m", "+0.250 rad"]);
});

test("the clause to look at first is the one asked for, the first that is violated, or the last", () => {
  const clauses = [clause("a", "holds", 1), clause("b", "violated", null), clause("c", "violated", 2), clause("d", "unknown", null)];
  assert.equal(firstClause(clauses, "d"), 3);
  assert.equal(firstClause(clauses, "https://example.org/a"), 0);
  assert.equal(firstClause(clauses, "gone"), 2);
  assert.equal(firstClause(clauses.slice(0, 1)), 0);
  assert.equal(firstClause([]), -1);
});

test("a recording is parsed from a link only", () => {
  const uri = "file:///m.bdd";
  assert.deepEqual(recordingOf({ uri, variant: "v", variation: 3, clause: "c", other: 1 }), { uri, variant: "v", variation: 3 });
  assert.deepEqual(recordingOf({ uri, run: 2, index: "0" }), { uri, run: 2 });
  assert.equal(recordingOf({ run: 2 }), undefined);
  assert.equal(recordingOf(uri), undefined);
  assert.equal(clauseOf({ uri, clause: "c" }), "c");
  assert.equal(clauseOf({ uri, clause: 1 }), undefined);
});

test("stored runs are told with how they came out", () => {
  const extent = { complete: true, state: "finished", finished: 5, total: 5 } as const;
  const run = { run: 3, folder: "", path: "m.bdd", model: "", seed: 1, ...extent, holds: 4, violated: 1, unknown: 0, problem: null };
  assert.ok(isRuns({ store: "", runs: [run] }));
  for (const wrong of [{ holds: "4" }, { state: "lost" }, { finished: undefined }, { total: null }]) {
    assert.ok(!isRuns({ store: "", runs: [{ ...run, ...wrong }] }), JSON.stringify(wrong));
  }
  assert.equal(outcome(run), "4 hold, 1 violated");
  assert.equal(outcome({ ...run, state: "interrupted", total: 9 }), "4 hold, 1 violated (interrupted: 5 of 9 finished)");
  const nothing = { ...run, holds: 0, violated: 0, finished: 0, total: 9 };
  assert.equal(outcome({ ...nothing, state: "died" }), "nothing judged (died: 0 of 9 finished)");
  assert.equal(outcome({ ...nothing, state: "stopped" }), "nothing judged (stopped at the first failure: 0 of 9 finished)");
});

test("an answer of another version is no trace", () => {
  const array = packed([], 0);
  const scenario = {
    index: 0, name: "t:fetch -- 1", values: "", story: "", variant: "", variation: 1, repetition: 1, seed: 1, verdict: "holds", trace: true,
  };
  const trace = {
    run: 1, folder: "", duration: 0, remark: "", scenario, frames: { times: array, poses: array, bodies: [] },
    ...{ shapes: [], meshes: [], bodies: [], workspaces: [], events: [], clauses: [clause("at-goal", "holds", null)] },
  };
  assert.ok(isTrace(trace));
  assert.ok(isTrace({ ...trace, a_later_field: 1 }));
  for (const name of Object.keys(trace)) {
    assert.ok(!isTrace({ ...trace, [name]: undefined }), name);
  }
  for (const name of Object.keys(scenario)) {
    assert.ok(!isTrace({ ...trace, scenario: { ...scenario, [name]: undefined } }), name);
  }
});

test("a reader sees which clauses have changed, and when that is unknown", () => {
  const one = clause("at-goal", "holds", null);
  assert.equal(ageOf([one, { ...one, stale: false }]), "");
  assert.match(ageOf([one, { ...one, stale: true }, { ...one, name: "in-hand", stale: true }]), /at-goal, in-hand have changed/);
  assert.match(ageOf([{ ...one, stale: true }]), /at-goal has changed/);
  assert.match(ageOf([{ ...one, stale: null }]), /has errors/);
});

test("the camera follows tools and moving elements, not links, in words", () => {
  const body = (name: string) => ({ name, position: [0, 0, 0], orientation: [1, 0, 0, 0] }) as const;
  const bodies = ["world", "env:ball", "env:table", "env:ur10/wrist", "env:ur10/tool"].map(body);
  const frames = { times: packed([], 0), bodies: [1, 3, 4], poses: packed([], 0) };
  assert.deepEqual(followable({ bodies, frames, tools: [{ agent: "env:ur10", body: 4 }] }), [
    { body: 4, words: "ur10 tool" },
    { body: 1, words: "ball" },
  ]);
  assert.deepEqual(followable({ bodies, frames }), [{ body: 1, words: "ball" }]);
});

test("forces are those of the picture that is shown, the largest first, and none is invented", () => {
  const frames = { times: packed([0, 1, 2], 3), bodies: [], poses: packed([], 0) };
  const force = (other: string, bodies: readonly [number | null, number | null], ...peaks: number[]) => {
    return { between: ["env:ur10", other] as const, bodies, peaks: packed(peaks, 3) };
  };
  const forces = [force("env:ball", [4, 1], 0, 1.5, 2), force("env:bin", [4, 2], 0, 0, 31.25), force("floor", [4, null], 0.01, 0, 3)];
  const pressed = new Pressed({ frames, forces });
  assert.deepEqual(pressed.at(0.5), []);
  assert.deepEqual(pressed.at(1.5), [{ between: [4, 1], words: "ur10 – ball 1.50 N" }]);
  assert.deepEqual(pressed.at(9).map(({ words }) => words), ["ur10 – bin 31.3 N", "ur10 – floor 3.00 N", "ur10 – ball 2.00 N"]);
  assert.deepEqual(pressed.at(9)[1]?.between, [4, 4]);
  assert.ok(pressed.any);
  assert.ok(!new Pressed({ frames, forces: null }).any);
  assert.deepEqual(new Pressed({ frames }).at(1), []);
});

test("a scenario is called by its name and number", () => {
  assert.deepEqual(["crit:bin-heights -- 12", "bin -- heights", "crit:alone"].map((name) => titleOf({ name })), ["bin-heights 12", "bin -- heights", "alone"]);
});
