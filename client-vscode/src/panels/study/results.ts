// The results of a run as they are stored and as `robbdd run --json` writes them; docs/schemas/run.schema.json.
import type * as answers from "../../answers/run";
import type * as answeredStudies from "../../answers/study";
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

/** The answer to `robbdd/study`: the stored executions of a study; docs/schemas/study.schema.json. */
export type StudyResults = Immutable<answeredStudies.StudyResults>;

export { isStudyResults } from "../../answers/validators.mjs";

/** The executions of a study; a study stores neither roles nor sentences of clauses. */
export function studiedScenarios({ executions }: StudyResults): JudgedScenario[] {
  return executions.map(({ clauses, ...execution }) => ({
    ...execution,
    clauses: clauses.map((clause) => ({ ...clause, role: "then" as const, sentence: "" })),
  }));
}

/** What is shown of a study, in words. */
export function studyTitle({ name, total, running, counts, executions }: StudyResults): string {
  const stored = counts.holds + counts.violated + counts.unknown;
  const [all, made, shown] = [total, stored, executions.length].map((number) => number.toLocaleString("en"));
  const verdicts = [`${counts.holds} hold`, `${counts.violated} violated`, `${counts.unknown} unknown`].filter((part) => !part.startsWith("0 "));
  const missing = stored < total ? ` (${running ? "in progress, " : ""}${made} of ${all} executed)` : "";
  const cut = executions.length < stored ? `; the first ${shown} are shown` : "";
  return `Study ${name}: ${verdicts.join(", ") || "nothing is stored yet"}${missing}${cut}`;
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
