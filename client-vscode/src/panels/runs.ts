// The server's answer to `robbdd/runs`: stored runs, the oldest first; docs/schemas/runs.schema.json.
import { isRecord } from "../values";
import type { Scenario } from "./replay/answer";

export interface StoredScenario extends Scenario {
  /** Whether its trace is kept. */
  readonly trace: boolean;
}

const STATES = ["running", "finished", "stopped", "interrupted", "failed", "died"] as const;

export interface StoredRun {
  readonly run: number;
  readonly folder: string;
  readonly path: string;
  readonly seed: number;
  readonly complete: boolean;
  readonly state: (typeof STATES)[number];
  /** How many of `total` scenarios are finished. */
  readonly finished: number;
  readonly total: number;
  readonly holds: number;
  readonly violated: number;
  readonly unknown: number;
  /** Why the run cannot be read. */
  readonly problem: string | null;
  readonly scenarios?: readonly StoredScenario[];
}

/** Whether an answer has the form of this version. */
export function isRuns(value: unknown): value is { readonly runs: readonly StoredRun[] } {
  return isRecord(value) && Array.isArray(value["runs"]) && value["runs"].every(isRun);
}

/** The verdicts of a run's scenarios, and the progress of an unfinished run. */
export function outcome({ holds, violated, unknown, state, finished, total }: StoredRun): string {
  const parts = [`${holds} hold`, `${violated} violated`, `${unknown} unknown`].filter((part) => !part.startsWith("0 "));
  const counts = parts.join(", ") || "nothing judged";
  const extent = `${finished} of ${total} finished`;
  return state === "finished" ? counts : `${counts} (${state === "stopped" ? "stopped at the first failure" : state}: ${extent})`;
}

/** Whether a value is a stored run of this version. */
export function isRun(value: unknown): value is StoredRun {
  return (
    isRecord(value) &&
    typeof value["run"] === "number" &&
    typeof value["path"] === "string" &&
    STATES.some((state) => state === value["state"]) &&
    ["holds", "violated", "unknown", "finished", "total"].every((name) => typeof value[name] === "number") &&
    (value["problem"] === null || typeof value["problem"] === "string")
  );
}
