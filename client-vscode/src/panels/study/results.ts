// The results of a run as they are stored and as `robbdd run --json` writes them; docs/schemas/run.schema.json.
import { isRecord } from "../../values";
import type { Verdict } from "../replay/answer";

export interface JudgedClause {
  readonly iri: string;
  readonly name: string;
  readonly role: string;
  readonly sentence: string;
  readonly verdict: Verdict;
  readonly robustness: number | null;
  readonly unit: string;
}

export interface JudgedScenario {
  readonly variant: string;
  readonly name: string;
  readonly values: Readonly<Record<string, unknown>>;
  readonly verdict: Verdict;
  readonly clauses: readonly JudgedClause[];
}

export interface Results {
  readonly complete: boolean;
  readonly scenarios: readonly JudgedScenario[];
}

/** Parse results; undefined for any other text. */
export function readResults(text: string): Results | undefined {
  let found: unknown;
  try {
    found = JSON.parse(text);
  } catch {
    return undefined;
  }
  return isResults(found) ? found : undefined;
}

function isResults(value: unknown): value is Results {
  return (
    isRecord(value) &&
    typeof value["complete"] === "boolean" &&
    Array.isArray(value["scenarios"]) &&
    value["scenarios"].every(isScenario)
  );
}

function isScenario(value: unknown): boolean {
  return (
    isRecord(value) &&
    typeof value["variant"] === "string" &&
    typeof value["name"] === "string" &&
    isRecord(value["values"]) &&
    isVerdict(value["verdict"]) &&
    Array.isArray(value["clauses"]) &&
    value["clauses"].every(isClause)
  );
}

function isClause(value: unknown): boolean {
  return (
    isRecord(value) &&
    ["iri", "name", "role", "sentence", "unit"].every((name) => typeof value[name] === "string") &&
    isVerdict(value["verdict"]) &&
    (value["robustness"] === null || typeof value["robustness"] === "number")
  );
}

function isVerdict(value: unknown): boolean {
  return value === "holds" || value === "violated" || value === "unknown";
}
