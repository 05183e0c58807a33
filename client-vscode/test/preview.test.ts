import assert from "node:assert/strict";
import { test } from "node:test";
import { type PreviewLine, isPreview, lineAt } from "../src/preview/answer";

const MODEL = "file:///m.bdd";
const entry = (line: number, from: [number, number], to: [number, number], uri = MODEL): PreviewLine => ({
  line,
  iri: "t:held",
  uri,
  range: { start: { line: from[0], character: from[1] }, end: { line: to[0], character: to[1] } },
});
// A clause at line 5 that two scenarios state, within a variant that spans lines 2 to 9.
const LINES = [
  entry(3, [2, 0], [9, 1]),
  entry(6, [5, 8], [5, 40]),
  entry(13, [2, 0], [9, 1]),
  entry(16, [5, 8], [5, 40]),
  entry(20, [5, 8], [5, 40], "file:///other.bdd"),
];

test("the cursor in a clause leads to its step in the scenario that is shown", () => {
  assert.equal(lineAt(LINES, MODEL, { line: 5, character: 20 }, 0), 6);
  assert.equal(lineAt(LINES, MODEL, { line: 5, character: 40 }, 14), 16);
});

test("a cursor outside the clauses selects the scenario's heading", () => {
  assert.equal(lineAt(LINES, MODEL, { line: 5, character: 41 }, 0), 3);
  assert.equal(lineAt(LINES, MODEL, { line: 2, character: 0 }, 30), 13);
});

test("the cursor outside of everything leads nowhere", () => {
  assert.equal(lineAt(LINES, MODEL, { line: 1, character: 0 }, 0), undefined);
  assert.equal(lineAt(LINES, "file:///none.bdd", { line: 5, character: 20 }, 0), undefined);
});

test("an answer of another version is told apart", () => {
  assert.ok(isPreview({ uri: MODEL, text: "", problem: null, lines: LINES, shown: 2, total: 2 }));
  assert.ok(isPreview({ uri: MODEL, text: "", problem: "line 1: oh", lines: [], shown: 0, total: 0 }));
  for (const other of [undefined, null, {}, { uri: MODEL, text: "", problem: null, shown: 0, total: 0 }, { uri: MODEL, text: "", problem: null, lines: [{}], shown: 0, total: 0 }]) {
    assert.ok(!isPreview(other));
  }
});
