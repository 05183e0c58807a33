// The server's answer to `robbdd/compare`: two stored runs side by side; docs/schemas/compare.schema.json.
import { signed } from "../../quantity";
import { isRecord } from "../../values";
import type { Verdict } from "../replay/answer";
import { type StoredRun, isRun } from "../runs";

/** All verdicts of one run on a clause. */
export interface Totals {
  readonly holding: number;
  readonly total: number;
  /** Smallest margin, SI. */
  readonly margin: number | null;
  readonly unit: string;
}

export interface ComparedClause {
  readonly iri: string;
  readonly name: string;
  readonly role: string;
  readonly before: Totals;
  readonly after: Totals;
}

/** An execution in one of the runs. */
export interface Side {
  readonly index: number;
  readonly verdict: Verdict;
  readonly seed: number;
  readonly trace: boolean;
}

export interface ClauseChange {
  readonly iri: string;
  readonly name: string;
  /** null: that run did not judge the clause. */
  readonly before: Verdict | null;
  readonly after: Verdict | null;
  readonly margin_before: number | null;
  readonly margin_after: number | null;
  readonly unit: string;
  readonly reason: string;
}

export interface Change {
  readonly name: string;
  readonly values: string;
  readonly repetition: number;
  /** null: that run does not have the execution. */
  readonly before: Side | null;
  readonly after: Side | null;
  readonly clauses: readonly ClauseChange[];
}

export interface Comparison {
  readonly before: StoredRun;
  readonly after: StoredRun;
  readonly inputs: readonly string[];
  readonly clauses: readonly ComparedClause[];
  readonly same: number;
  readonly flipped: number;
  readonly changes: readonly Change[];
}

/** Whether an answer has the form of this version: its parts, but not every number. */
export function isComparison(value: unknown): value is Comparison {
  return (
    isRecord(value) &&
    isRun(value["before"]) &&
    isRun(value["after"]) &&
    typeof value["same"] === "number" &&
    typeof value["flipped"] === "number" &&
    ["inputs", "clauses", "changes"].every((name) => Array.isArray(value[name])) &&
    (value["clauses"] as unknown[]).every((one) => isRecord(one) && isRecord(one["before"]) && isRecord(one["after"])) &&
    (value["changes"] as unknown[]).every((one) => isRecord(one) && Array.isArray(one["clauses"]))
  );
}

const SIGNS = { holds: "✔", violated: "✗", unknown: "?" } as const;

/** A verdict as a sign; a dash if there is none. */
export function sign(verdict: Verdict | null | undefined): string {
  return verdict == null ? "–" : SIGNS[verdict];
}

/** `at-goal ✔ → ✗ (+12.0 mm → −3.00 mm): too far`. */
export function changeWords({ name, before, after, margin_before, margin_after, unit, reason }: ClauseChange): string {
  const margins = [margin_before, margin_after].map((margin) => (margin === null || unit === "" ? "–" : signed(margin, unit)));
  const moved = margins.every((margin) => margin === "–") ? "" : ` (${margins.join(" → ")})`;
  return `${name} ${sign(before)} → ${sign(after)}${moved}${reason === "" ? "" : `: ${reason}`}`;
}

/** `3/4, worst −3.00 mm`. */
export function totalsWords({ holding, total, margin, unit }: Totals): string {
  if (total === 0) {
    return "not judged";
  }
  return `${holding}/${total}${margin === null || unit === "" ? "" : `, worst ${signed(margin, unit)}`}`;
}

/** `1 flipped, 3 the same, 1 only in run 2`. */
export function summaryOf({ before, after, flipped, same, changes }: Comparison): string {
  const only = (missing: "before" | "after") => changes.filter((change) => change[missing] === null).length;
  const parts = [`${flipped} flipped`, `${same} the same`];
  const others = [[only("after"), before.run], [only("before"), after.run]] as const;
  return [...parts, ...others.filter(([count]) => count > 0).map(([count, run]) => `${count} only in run ${run}`)].join(", ");
}
