import assert from "node:assert/strict";
import { test } from "node:test";
import type { CodeLens, TextDocument } from "vscode";
import type { VerdictHints } from "../src/answers/verdicts";
import { appearanceOf, marksOfHints, marksOfLenses } from "../src/verdicts/marks";

const FRESH = { stale: false, rejudged: false, consequence: false, reason: "" };
const LINES = ["Scenario tidy {", "    at-goal: holds(<thing>)", "    | <cube> | <bin> |"];

test("a hint without a verdict has no mark", () => {
  for (const data of [undefined, null, 1, "holds", {}, { stale: true }, { verdict: 1 }]) {
    assert.equal(appearanceOf({ label: "✔ 4/4", data }), undefined);
  }
  assert.equal(appearanceOf({ label: "✔ 4/4" }), undefined);
});

test("what a server of another version sends remains a plain hint, and fields that it has added do not matter", () => {
  assert.deepEqual(appearanceOf({ data: { verdict: "holds", stale: false } }), { verdict: "holds", ...FRESH });
  assert.equal(appearanceOf({ data: { verdict: "perhaps", stale: true } }), undefined);
  assert.equal(appearanceOf({ data: { verdict: "holds" } }), undefined);
  assert.equal(appearanceOf({ data: { verdict: "holds", stale: false, added: 1 } })?.verdict, "holds");
});

test("*holds* is drawn after its clause, other verdicts before it, but after the row of a table, what is re-judged and a consequence", () => {
  const found = marksOfHints(text(), [
    hint(1, 27, "✔ 4/4", { verdict: "holds", stale: false }, "thing = cube: ✔"),
    hint(1, 27, "✗ 0/4 (stale)", { verdict: "violated", stale: true }),
    hint(1, 27, "? 0/4", { verdict: "unknown", stale: false }),
    hint(2, 22, "✗ at-goal", { verdict: "violated", stale: false }),
    hint(1, 27, "✗ 0 of 4 hold", { verdict: "violated", stale: false, rejudged: true }),
    hint(1, 27, "? because of carry", { verdict: "unknown", stale: false, consequence: true }),
    hint(1, 27, "? unknown", { verdict: "unknown", stale: false, reason: "it timed out" }),
    hint(0, 13, "4 scenarios", undefined),
  ]);
  assert.deepEqual(
    found.map(({ words, line, character, side }) => [words, line, character, side]),
    [
      ["✔ 4/4", 1, 27, "after"],
      ["✗ 0/4 (stale)", 1, 4, "before"],
      ["? 0/4", 1, 4, "before"],
      ["✗ at-goal", 2, 22, "after"],
      ["✗ 0 of 4 hold", 1, 27, "after"],
      ["? because of carry", 1, 27, "after"],
      ["? unknown: it timed out", 1, 4, "before"],
    ],
  );
  assert.deepEqual(found.map(({ tooltip }) => tooltip), ["thing = cube: ✔", "", "", "", "", "", ""]);
});

for (const [place, columns] of [["short", 27], ["long", 120]] as const) {
  test(`the reason is before a clause in a ${place} line, since the editor may draw none after it`, () => {
    const document = { lineAt: () => ({ text: "x".repeat(columns), firstNonWhitespaceCharacterIndex: 4 }) } as unknown as TextDocument;
    const shown = (data: object, words = "? unknown") => marksOfHints(document, [hint(0, columns, words, data)]).map(({ words }) => words);
    const unknown = { verdict: "unknown", stale: false };
    assert.deepEqual(shown({ ...unknown, reason: "it timed out" }), ["? unknown: it timed out"]);
    assert.deepEqual(shown({ ...unknown, reason: `it timed out${" again".repeat(20)}` }), [`? unknown: it timed out${" again".repeat(9)} agai…`]);
    assert.deepEqual(shown(unknown), ["? unknown"]);
    assert.deepEqual(shown({ ...unknown, reason: "it timed out" }, "✗"), ["✗ it timed out"]);
  });
}

const WIDE = `    at-goal: holds(${"x".repeat(80)})`;

for (const [place, lines, expected] of [
  ["the line below", ["(", WIDE, "    and"], ["↑ ✗ 4 flipped", 2, 7, "after"]],
  ["the line above, if the one below is long, too", ["Then:", WIDE, WIDE], ["↓ ✗ 4 flipped", 0, 5, "after"]],
  ["the line above the last line", ["Then:", WIDE], ["↓ ✗ 4 flipped", 0, 5, "after"]],
  ["its beginning, if both are long", [WIDE, WIDE, WIDE], ["✗ 4 flipped", 1, 4, "before"]],
  ["its end, if that is in sight", ["(", WIDE.slice(5), "    and"], ["✗ 4 flipped", 1, 95, "after"]],
] as const) {
  test(`what is re-judged in a wide line is drawn at ${place}`, () => {
    const column = lines[1].length;
    const found = marksOfHints(text(lines), [hint(1, column, "✗ 4 flipped", { verdict: "violated", stale: false, rejudged: true })]);
    assert.deepEqual(found.map(({ words, line, character, side }) => [words, line, character, side]), [expected]);
  });
}

test("every verdict of an execution is drawn before a clause that ends out of sight", () => {
  const data = [{ verdict: "holds" }, { verdict: "violated" }, { verdict: "unknown", consequence: true }];
  const hints = data.map((one) => hint(1, WIDE.length, "4", { stale: false, ...one }));
  const found = marksOfHints(text(["", WIDE, ""]), hints);
  assert.deepEqual(found.map(({ words, line, character, side }) => [words, line, character, side]), Array(3).fill(["4", 1, 4, "before"]));
});

test("a clause that ends in sight has its verdict after it, even if a comment follows", () => {
  const line = `${WIDE.slice(5)} // ${"a comment ".repeat(5)}`;
  const [found] = marksOfHints(text([line]), [hint(0, 95, "✔ 4/4", { verdict: "holds", stale: false })]);
  assert.deepEqual([found?.character, found?.side], [95, "after"]);
});

test("the pass rate of a wide line is drawn before it", () => {
  const found = marksOfLenses(text([WIDE, WIDE]), [lens("✔ 4/4 passed", { verdict: "holds", ...FRESH })]);
  assert.deepEqual(found.map(({ line, character, side }) => [line, character, side]), [[0, 4, "before"]]);
});

test("a pass rate is drawn at the end of the line below its lens", () => {
  const rate = { verdict: "violated", ...FRESH };
  const lenses = [lens("Run", undefined), lens("✗ 3/4 passed", rate)];
  assert.deepEqual(marksOfLenses(text(), lenses), [
    { ...rate, words: "✗ 3/4 passed", line: 0, character: 15, side: "after", tooltip: "" },
  ]);
});

function hint(line: number, character: number, label: string, data: unknown, tooltip?: string): VerdictHints[number] {
  return { position: { line, character }, label, tooltip, data } as VerdictHints[number];
}

function lens(title: string, data: unknown): CodeLens {
  return { range: { start: { line: 0, character: 9 } }, command: { title, command: "" }, data } as unknown as CodeLens;
}

function text(lines: readonly string[] = LINES): Pick<TextDocument, "lineAt" | "lineCount"> {
  const lineAt = (line: number) => {
    const found = lines[line] ?? "";
    return { text: found, firstNonWhitespaceCharacterIndex: found.search(/\S/) };
  };
  return { lineAt, lineCount: lines.length } as TextDocument;
}
