// Rows and columns of the matrix of verdicts: executions by clauses, sorted and filtered.
import type { JudgedClause, JudgedScenario } from "../../src/panels/study/results";
import { shown } from "./tables";

export type Verdict = JudgedScenario["verdict"];

export interface Row {
  /** Number of the execution in the run. */
  readonly index: number;
  readonly words: string;
  readonly verdict: Verdict;
  /** By column; undefined where the execution has no such clause. */
  readonly cells: readonly (JudgedClause | undefined)[];
}

export interface Wish {
  /** Words that must occur in a row. */
  readonly text: string;
  /** Rows with this verdict; empty for all. */
  readonly verdict: Verdict | "";
  /** Only clauses that do not hold everywhere. */
  readonly failing: boolean;
  /** The column that rows are sorted by; `ROWS` for the order of the run, `WHOLE` for the verdict of the execution. */
  readonly by: number;
  readonly descending: boolean;
}

export const ROWS = -2;
export const WHOLE = -1;
const RANK = { violated: 0, unknown: 1, holds: 2 } as const;

/** One row for each execution; `named` shortens the names of variables. */
export function rowsOf(scenarios: readonly JudgedScenario[], clauses: readonly JudgedClause[], named: (name: string) => string): Row[] {
  return scenarios.map(({ values, verdict, clauses: judged }, index) => {
    const found = new Map(judged.map((clause) => [clause.iri, clause]));
    const words = Object.entries(values).map(([name, value]) => `${named(name)} = ${shown(value)}`);
    return { index, words: words.join(", "), verdict, cells: clauses.map(({ iri }) => found.get(iri)) };
  });
}

/** The columns to show. */
export function columnsOf(rows: readonly Row[], count: number, { failing }: Wish): number[] {
  const every = Array.from({ length: count }, (_, column) => column);
  return failing ? every.filter((column) => rows.some(({ cells }) => (cells[column]?.verdict ?? "holds") !== "holds")) : every;
}

/** The rows to show, in order: the worst first, unless descending. Rows that are equal keep the order of the run. */
export function arranged(rows: readonly Row[], { text, verdict, by, descending }: Wish): Row[] {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const left = rows.filter((row) => {
    return (verdict === "" || row.verdict === verdict) && words.every((word) => row.words.toLowerCase().includes(word));
  });
  const sign = descending ? -1 : 1;
  if (by === ROWS) {
    return descending ? left.reverse() : left;
  }
  return left.sort((one, other) => sign * compared(one, other, by) || one.index - other.index);
}

function compared(one: Row, other: Row, by: number): number {
  if (by === WHOLE) {
    return RANK[one.verdict] - RANK[other.verdict];
  }
  const [first, second] = [one.cells[by], other.cells[by]];
  // What was not judged is last.
  const rank = (clause: JudgedClause | undefined) => (clause === undefined ? 3 : RANK[clause.verdict]);
  return rank(first) - rank(second) || (first?.robustness ?? 0) - (second?.robustness ?? 0);
}

/** The part of `count` lines of `size` px that a window of `length` px at `start` shows, with a few more on both sides. */
export function inSight(start: number, length: number, size: number, count: number): readonly [first: number, end: number] {
  const more = 4;
  const first = Math.max(0, Math.floor(start / size) - more);
  return [Math.min(first, count), Math.min(count, Math.ceil((start + length) / size) + more)];
}
