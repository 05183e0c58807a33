// The server's answer to `robbdd/history`: the verdicts on one clause in the stored runs; docs/schemas/history.schema.json.
import { signed } from "../../quantity";
import { isRecord } from "../../values";
import type { Verdict } from "../replay/answer";

export interface ClauseRun {
  readonly run: number;
  readonly path: string;
  readonly state: string;
  /** ISO 8601. */
  readonly began: string;
  /** Number of executions by the clause's verdict. */
  readonly judged: Readonly<Record<Verdict, number>>;
  /** Smallest margin, SI. */
  readonly margin: number | null;
  readonly unit: string;
  /** Number of the worst execution. */
  readonly worst: number;
  /** Whether the clause's text has changed since; null if unknown. */
  readonly stale: boolean | null;
}

export interface ClauseHistory {
  readonly clause: string;
  readonly name: string;
  readonly runs: readonly ClauseRun[];
}

/** Whether an answer has the form of this version. */
export function isHistory(value: unknown): value is ClauseHistory {
  return (
    isRecord(value) &&
    typeof value["clause"] === "string" &&
    typeof value["name"] === "string" &&
    Array.isArray(value["runs"]) &&
    value["runs"].every(isRun)
  );
}

function isRun(value: unknown): boolean {
  return (
    isRecord(value) &&
    ["run", "worst"].every((name) => typeof value[name] === "number") &&
    ["path", "state", "began", "unit"].every((name) => typeof value[name] === "string") &&
    isRecord(value["judged"]) &&
    (value["margin"] === null || typeof value["margin"] === "number")
  );
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
