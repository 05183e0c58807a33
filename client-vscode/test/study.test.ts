import assert from "node:assert/strict";
import { test } from "node:test";
import { type JudgedScenario, readResults } from "../src/panels/study/results";
import { cell, clauses, dimensions, histogram, shown } from "../webviews/study/tables";

const IRI = "https://example.org/at-goal";
const scenario = (robot: string, scale: number, robustness: number | null): JudgedScenario => {
  const verdict = robustness === null ? "unknown" : robustness < 0 ? "violated" : "holds";
  const clause = { iri: IRI, name: "at-goal", role: "then", sentence: "at goal", verdict, robustness, unit: "m" } as const;
  return { variant: "v", name: "s", values: { robot: `env:${robot}`, scale, part: "env:cube" }, verdict, clauses: [clause] };
};
const SCENARIOS = [
  scenario("panda", 1.1, 0.015),
  scenario("panda", 0.8, 0.03),
  scenario("ur10", 1.1, -0.05),
  scenario("ur10", 1.1, -0.01),
  scenario("ur10", 1.1, null),
];

test("the dimensions are the variables with several values, numbers in their order", () => {
  assert.deepEqual(dimensions(SCENARIOS), [
    { name: "robot", values: ["panda", "ur10"] },
    { name: "scale", values: ["0.8", "1.1"] },
  ]);
  assert.deepEqual(dimensions([]), []);
});

test("values are shown without prefixes, lists with commas, addresses whole", () => {
  assert.deepEqual([shown("env:cube"), shown(1.5), shown(["env:a", "env:b"]), shown("https://e.org/a")], ["cube", "1.5", "a, b", "https://e.org/a"]);
});

test("a cell counts what passed and leads to the worst execution", () => {
  const where = [["robot", "ur10"], ["scale", "1.1"]] as const;
  assert.deepEqual(cell(SCENARIOS, where, IRI), { passed: 0, total: 3, worst: -0.05, unit: "m", index: 2 });
  assert.deepEqual(cell(SCENARIOS, [], ""), { passed: 2, total: 5, worst: undefined, unit: "", index: 2 });
  assert.deepEqual(cell(SCENARIOS, [["robot", "panda"]], IRI), { passed: 2, total: 2, worst: 0.015, unit: "m", index: 0 });
  assert.equal(cell(SCENARIOS, [["robot", "ur10"], ["scale", "0.8"]], ""), undefined);
});

test("each clause is told once", () => {
  assert.deepEqual(clauses(SCENARIOS).map(({ name }) => name), ["at-goal"]);
});

test("margins are counted in bins with a bound at zero, so that no bar is both good and bad", () => {
  const bins = histogram(SCENARIOS, IRI, 8);
  assert.equal(bins.reduce((sum, { count }) => sum + count, 0), 4, "what is unknown has no margin");
  assert.ok(bins.every(({ from, to }) => to <= 1e-12 || from >= -1e-12));
  assert.deepEqual(bins.filter(({ count }) => count > 0).map(({ index }) => index), [2, 3, 0, 1]);
  assert.ok((bins[0]?.from ?? 0) <= -0.05 && (bins.at(-1)?.to ?? 0) >= 0.03);
  assert.deepEqual(histogram(SCENARIOS, "another", 8), []);
});

test("results are read from their text, and nothing else is", () => {
  assert.equal(readResults(JSON.stringify({ complete: true, scenarios: SCENARIOS }))?.scenarios.length, 5);
  for (const text of ["", "{", "[]", '{"complete": true}', '{"complete": true, "scenarios": [{}]}']) {
    assert.equal(readResults(text), undefined, text);
  }
});
