// Results on their way to the page: texts of clauses once, not with each execution. Thousands of executions of 40 clauses
// would take seconds otherwise.
import type { Verdict } from "../replay/answer";
import type { JudgedClause, JudgedScenario } from "./results";

type ClauseTexts = Omit<JudgedClause, "verdict" | "robustness">;

export interface PackedResults {
  readonly texts: readonly ClauseTexts[];
  readonly scenarios: readonly (Omit<JudgedScenario, "clauses"> & { readonly judged: readonly Judgement[] })[];
}

/** The number of the clause's texts in `texts`, and its result. */
type Judgement = readonly [number: number, verdict: Verdict, robustness: number | null];

export function packed(scenarios: readonly JudgedScenario[]): PackedResults {
  const numbers = new Map<string, number>();
  const texts: ClauseTexts[] = [];
  const numberOf = ({ iri, name, role, sentence, unit }: JudgedClause): number => {
    // The sentence of a clause differs between executions, but only its first one is shown.
    const key = `${iri} ${name} ${role} ${unit}`;
    const known = numbers.get(key) ?? texts.push({ iri, name, role, sentence, unit }) - 1;
    numbers.set(key, known);
    return known;
  };
  return {
    scenarios: scenarios.map(({ variant, name, values, verdict, clauses }) => {
      const judged = clauses.map((clause): Judgement => [numberOf(clause), clause.verdict, clause.robustness]);
      return { variant, name, values, verdict, judged };
    }),
    texts,
  };
}

export function unpacked({ texts, scenarios }: PackedResults): JudgedScenario[] {
  return scenarios.map(({ judged, ...scenario }) => ({
    ...scenario,
    clauses: judged.flatMap(([number, verdict, robustness]) => {
      const known = texts[number];
      return known === undefined ? [] : [{ ...known, verdict, robustness }];
    }),
  }));
}
