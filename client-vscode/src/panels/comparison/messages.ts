// Messages between the extension and the page that compares two runs.
import type { Comparison } from "./answer";

/** Selects two stored runs by their numbers. */
export interface RunPair {
  /** A document of the project. */
  readonly uri: string;
  readonly before: number;
  readonly after: number;
}

export interface ToComparison {
  readonly type: "comparison";
  readonly pair: RunPair;
  readonly comparison: Comparison;
}

/** In addition to `{ type: "ready" }`: the number of an execution in each run, to be replayed side by side. */
export interface FromComparison {
  readonly type: "replay";
  readonly before?: number;
  readonly after?: number;
  /** IRI of the clause to select. */
  readonly clause?: string;
}

/** State that the page keeps over reloads. */
export interface ComparisonState {
  readonly pair: RunPair;
}
