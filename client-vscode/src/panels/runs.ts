// The server's answer to `robbdd/runs`: stored runs, the oldest first; docs/schemas/runs.schema.json.
import { isRecord } from "../values";
import type { Scenario } from "./replay/answer";

export interface StoredScenario extends Scenario {
  /** Whether its trace is kept. */
  readonly trace: boolean;
}

export interface StoredRun {
  readonly run: number;
  readonly folder: string;
  readonly path: string;
  readonly seed: number;
  readonly complete: boolean;
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

/** How the scenarios of a run came out, in words. */
export function outcome({ holds, violated, unknown, complete }: StoredRun): string {
  const parts = [`${holds} hold`, `${violated} violated`, `${unknown} unknown`];
  return `${parts.filter((part) => !part.startsWith("0 ")).join(", ") || "nothing judged"}${complete ? "" : ", not complete"}`;
}

function isRun(value: unknown): boolean {
  return (
    isRecord(value) &&
    typeof value["run"] === "number" &&
    typeof value["path"] === "string" &&
    ["holds", "violated", "unknown"].every((name) => typeof value[name] === "number") &&
    (value["problem"] === null || typeof value["problem"] === "string")
  );
}
