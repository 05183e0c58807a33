// The server's answer to `robbdd/compare`: two stored runs side by side; docs/schemas/compare.schema.json.
import type * as answers from "../../answers/compare";
import type { Immutable } from "../../immutable";
import { signed } from "../../quantity";
import type { Verdict } from "../replay/answer";

export { isComparison } from "../../answers/validators.mjs";

export type Comparison = Immutable<answers.Comparison>;
/** All verdicts of one run on a clause. */
export type Totals = Immutable<answers.Totals>;
export type ComparedClause = Immutable<answers.Clause>;
/** An execution in one of the runs. */
export type Side = NonNullable<Immutable<answers.Side>>;
export type Change = Immutable<answers.Change>;
export type ClauseChange = Change["clauses"][number];

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
