// The server's answer to `robbdd/history`: the verdicts on one clause in the stored runs; docs/schemas/history.schema.json.
import type * as answers from "../../answers/history";
import { isClauseHistory } from "../../answers/validators.mjs";
import type { Immutable } from "../../immutable";
import { signed } from "../../quantity";
import type { Verdict } from "../replay/answer";

export type ClauseHistory = NonNullable<Immutable<answers.ClauseHistory>>;
export type ClauseRun = Immutable<answers.Run>;

/** Whether an answer has the form of this version and names a clause. */
export function isHistory(value: unknown): value is ClauseHistory {
  return value !== null && isClauseHistory(value);
}

/** The worst verdict of a run. */
export function verdictOf({ judged }: ClauseRun): Verdict {
  return judged.violated > 0 ? "violated" : judged.unknown > 0 ? "unknown" : "holds";
}

/** How many executions hold, such as `3/4`. */
export function rateOf({ judged }: ClauseRun): string {
  return `${judged.holds}/${judged.holds + judged.violated + judged.unknown}`;
}

export function marginOf({ margin, unit }: ClauseRun): string {
  return margin === null || unit === "" ? "" : signed(margin, unit);
}

/** What else is to be known about a run: an end before its time, a text that has changed since. */
export function remarkOf({ state, stale }: ClauseRun): string {
  const unfinished = state === "finished" ? [] : [state === "stopped" ? "stopped at the first failure" : state];
  return [...unfinished, ...(stale === true ? ["the clause has changed since"] : [])].join(", ");
}

/** One line about all runs: `holds in 2 of 3 runs`. */
export function summaryOf({ runs }: ClauseHistory): string {
  const holding = runs.filter((run) => verdictOf(run) === "holds").length;
  return `holds in ${holding} of ${runs.length} run${runs.length === 1 ? "" : "s"}`;
}
