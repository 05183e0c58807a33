import assert from "node:assert/strict";
import { test } from "node:test";
import { type JudgedScenario, readResults } from "../src/panels/study/results";
import { packed, unpacked } from "../src/panels/study/packed";
import { intervalWords, wilson } from "../src/statistics";
import { type Wish, ROWS, WHOLE, arranged, columnsOf, inSight, rowsOf } from "../webviews/study/matrix";
import { cell, clauses, dimensions, failing, histogram, local, openingPair, shown } from "../webviews/study/tables";

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
  assert.deepEqual(cell(SCENARIOS, where, IRI), { passed: 0, total: 3, worst: -0.05, unit: "m", unknown: 1, indices: [2, 3, 4] });
  assert.deepEqual(cell(SCENARIOS, [], ""), { passed: 2, total: 5, worst: undefined, unit: "", unknown: 1, indices: [2, 3, 4, 0, 1] });
  assert.deepEqual(cell(SCENARIOS, [["robot", "panda"]], IRI), { passed: 2, total: 2, worst: 0.015, unit: "m", unknown: 0, indices: [0, 1] });
  assert.equal(cell(SCENARIOS, [["robot", "ur10"], ["scale", "0.8"]], ""), undefined);
});

test("what does not hold is listed over all values, the worst first", () => {
  assert.deepEqual(failing(SCENARIOS, IRI), [2, 3, 4]);
  assert.deepEqual(failing(SCENARIOS, ""), [2, 3, 4]);
  assert.deepEqual(failing(SCENARIOS.slice(0, 2), ""), []);
  assert.deepEqual(failing([], ""), []);
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
  const stored = SCENARIOS.map(({ clauses: judged, ...one }) => ({
    story: "s", variation: 1, seed: 1, ...one, clauses: judged.map((clause) => ({ ...clause, at: null, reason: "" })),
  }));
  const results = { seed: 1, model: "cell.bdd", complete: true, scenarios: stored };
  assert.equal(readResults(JSON.stringify(results))?.scenarios.length, 5);
  for (const text of ["", "{", "[]", '{"complete": true}', JSON.stringify({ ...results, scenarios: [{}] })]) {
    assert.equal(readResults(text), undefined, text);
  }
});

test("a study opens on the swept factor: numbers first, then what has most values", () => {
  const names = openingPair(dimensions(SCENARIOS)).map((one) => one?.name);
  assert.deepEqual(names, ["scale", "robot"]);
  const words = [{ name: "robot", values: ["a", "b"] }, { name: "part", values: ["c", "d", "e"] }];
  assert.deepEqual(openingPair(words).map((one) => one?.name), ["part", "robot"]);
  assert.deepEqual(openingPair([]), [undefined, undefined]);
});

test("an interval is Wilson's, and covers what is unknown either way", () => {
  // Published: 8 of 10 is 0.4902 to 0.9433, 0 of 10 is 0 to 0.2775 (Newcombe 1998, method 3 for others).
  const rounded = (...counts: [number, number, number?]) => wilson(...counts).map((share) => Math.round(share * 1e4) / 1e4);
  assert.deepEqual(rounded(8, 10), [0.4902, 0.9433]);
  assert.deepEqual(rounded(0, 10), [0, 0.2775]);
  assert.deepEqual(rounded(81, 263), [0.2553, 0.3662]);
  assert.deepEqual(wilson(10, 10)[1], 1);
  assert.deepEqual([wilson(6, 10, 2)[0], wilson(6, 10, 2)[1]], [wilson(6, 10)[0], wilson(8, 10)[1]]);
  assert.deepEqual(wilson(0, 0), [0, 1]);
  assert.equal(intervalWords(1, 1), "21–100 %");
});

test("results reach the page as they are, with the texts of each clause once", () => {
  const sent = packed(SCENARIOS);
  assert.equal(sent.texts.length, 1);
  assert.deepEqual(unpacked(JSON.parse(JSON.stringify(sent)) as typeof sent), SCENARIOS);
});

const WISH: Wish = { text: "", verdict: "", failing: false, by: ROWS, descending: false };
const ROWS_OF = rowsOf(SCENARIOS, clauses(SCENARIOS), local);

test("the matrix is filtered by words and verdicts, and sorted by a clause with the worst margin first", () => {
  const order = (wish: Partial<Wish>) => arranged(ROWS_OF, { ...WISH, ...wish }).map(({ index }) => index);
  assert.deepEqual(order({}), [0, 1, 2, 3, 4]);
  assert.deepEqual(order({ descending: true }), [4, 3, 2, 1, 0]);
  assert.deepEqual(order({ text: "UR10  scale" }), [2, 3, 4]);
  assert.deepEqual(order({ text: "scale = 0.8" }), [1]);
  assert.deepEqual(order({ verdict: "unknown" }), [4]);
  assert.deepEqual(order({ by: WHOLE }), [2, 3, 4, 0, 1]);
  assert.deepEqual(order({ by: 0 }), [2, 3, 4, 0, 1]);
  assert.deepEqual(order({ by: 0, descending: true }), [1, 0, 4, 3, 2]);
  assert.equal(ROWS_OF.length, 5, "the rows themselves stay as they are");
});

test("a clause that holds everywhere can be left out, and one that was not judged is last", () => {
  const other = { ...SCENARIOS[0]?.clauses[0], iri: "https://example.org/height", verdict: "holds" } as const;
  const [first, ...rest] = SCENARIOS;
  assert.ok(first);
  const scenarios = [{ ...first, clauses: [...first.clauses, other as (typeof first.clauses)[number]] }, ...rest];
  const rows = rowsOf(scenarios, clauses(scenarios), local);
  assert.deepEqual(columnsOf(rows, 2, WISH), [0, 1]);
  assert.deepEqual(columnsOf(rows, 2, { ...WISH, failing: true }), [0]);
  assert.deepEqual(arranged(rows, { ...WISH, by: 1 }).map(({ index }) => index), [0, 1, 2, 3, 4]);
});

test("only what is in sight of thousands of rows is drawn", () => {
  assert.deepEqual(inSight(0, 480, 24, 1680), [0, 24]);
  assert.deepEqual(inSight(24_000, 480, 24, 1680), [996, 1024]);
  assert.deepEqual(inSight(40_000, 480, 24, 1680), [1662, 1680]);
  assert.deepEqual(inSight(0, 480, 24, 3), [0, 3]);
});
