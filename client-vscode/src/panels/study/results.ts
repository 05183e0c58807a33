// The results of a run as they are stored and as `robbdd run --json` writes them; docs/schemas/run.schema.json.
import type * as answers from "../../answers/run";
import { isRunResults } from "../../answers/validators.mjs";
import type { Immutable } from "../../immutable";

/** What the page shows of a clause; older runs lack the other fields. */
export type JudgedClause = Immutable<Pick<answers.Clause, "iri" | "name" | "role" | "sentence" | "verdict" | "robustness" | "unit">>;

export type JudgedScenario = Immutable<Pick<answers.Scenario, "variant" | "name" | "verdict">> & {
  readonly values: Readonly<Record<string, unknown>>;
  readonly clauses: readonly JudgedClause[];
};

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
  return isRunResults(found) ? found : undefined;
}
