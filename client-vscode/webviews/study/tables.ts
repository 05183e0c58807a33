// Tabulate results: by the values of two variables, and by margin.
import type { JudgedClause, JudgedScenario } from "../../src/panels/study/results";

/** A variable that has more than one value in the results. */
export interface Dimension {
  readonly name: string;
  /** Numbers in numeric order, other values in order of the results. */
  readonly values: readonly string[];
}

export interface Cell {
  readonly passed: number;
  readonly total: number;
  /** The smallest margin among them; undefined without any. */
  readonly worst: number | undefined;
  readonly unit: string;
  readonly unknown: number;
  /** Numbers of the scenarios, the worst outcome first. */
  readonly indices: readonly number[];
}

export interface Bin {
  readonly from: number;
  readonly to: number;
  readonly count: number;
  /** Number of the scenario with the smallest margin in it; -1 for none. */
  readonly index: number;
}

/** Something judged: a whole scenario or one of its clauses. */
interface Outcome {
  readonly index: number;
  readonly verdict: JudgedScenario["verdict"];
  readonly robustness: number | null;
  readonly unit: string;
}

const RANK = { violated: 0, unknown: 1, holds: 2 } as const;

/** A value for display: names without prefix, lists with commas. */
export function shown(value: unknown): string {
  if (Array.isArray(value)) {
    return value.map(shown).join(", ");
  }
  return String(value).replace(/^[\w-]+:(?=[^/])/, "");
}

/** The local name of a variable: the end of its IRI or CURIE. */
export function local(name: string): string {
  return name.replace(/^.*[/#:]/, "").replace(/^var-/, "");
}

/** The variables with several values, in the order of the results. */
export function dimensions(scenarios: readonly JudgedScenario[]): Dimension[] {
  const found = new Map<string, Set<string>>();
  for (const { values } of scenarios) {
    for (const [name, value] of Object.entries(values)) {
      found.set(name, (found.get(name) ?? new Set()).add(shown(value)));
    }
  }
  return [...found].filter(([, values]) => values.size > 1).map(([name, values]) => ({ name, values: ordered([...values]) }));
}

/**
 * The dimensions to show first: the swept one, and one to compare with. Numbers are what a study sweeps, and what has most
 * values is swept rather than chosen.
 */
export function openingPair(found: readonly Dimension[]): readonly [across: Dimension | undefined, down: Dimension | undefined] {
  const numeric = ({ values }: Dimension) => values.every((value) => value !== "" && Number.isFinite(Number(value)));
  const rank = (one: Dimension) => (numeric(one) ? 1e6 : 0) + one.values.length;
  const [across, down] = [...found].sort((one, other) => rank(other) - rank(one));
  return [across, down];
}

/** The distinct clauses of the results, in scenario order. */
export function clauses(scenarios: readonly JudgedScenario[]): JudgedClause[] {
  const found = new Map<string, JudgedClause>();
  for (const clause of scenarios.flatMap((scenario) => scenario.clauses)) {
    if (!found.has(clause.iri)) {
      found.set(clause.iri, clause);
    }
  }
  return [...found.values()];
}

/**
 * The results for given values of two variables (`undefined`: any), of a clause if its IRI is given, else of whole
 * scenarios. Undefined if nothing was executed.
 */
export function cell(
  scenarios: readonly JudgedScenario[],
  where: readonly (readonly [name: string, value: string])[],
  clause: string,
): Cell | undefined {
  const outcomes = scenarios.flatMap((scenario, index) =>
    where.every(([name, value]) => shown(scenario.values[name]) === value) ? outcomesOf(scenario, index, clause) : [],
  );
  const ordered = [...outcomes].sort((one, other) => RANK[one.verdict] - RANK[other.verdict] || compare(margin(one), margin(other)));
  const [first] = ordered;
  if (first === undefined) {
    return undefined;
  }
  const margins = outcomes.map(margin).filter(Number.isFinite);
  return {
    passed: outcomes.filter(({ verdict }) => verdict === "holds").length,
    total: outcomes.length,
    worst: clause === "" || margins.length === 0 ? undefined : Math.min(...margins),
    unit: first.unit,
    unknown: outcomes.filter(({ verdict }) => verdict === "unknown").length,
    indices: ordered.map(({ index }) => index),
  };
}

/** The numbers of all scenarios that do not hold, or in which a clause does not hold if its IRI is given; the worst first. */
export function failing(scenarios: readonly JudgedScenario[], clause: string): readonly number[] {
  const all = cell(scenarios, [], clause);
  return all === undefined ? [] : all.indices.slice(0, all.total - all.passed);
}

/** The margins of a clause in `count` bins of equal width, with a boundary at zero if they have both signs. */
export function histogram(scenarios: readonly JudgedScenario[], clause: string, count: number): Bin[] {
  const outcomes = scenarios.flatMap((scenario, index) => outcomesOf(scenario, index, clause));
  const judged = outcomes.filter(({ robustness }) => robustness !== null);
  const margins = judged.map(margin);
  const [low, high] = [Math.min(0, ...margins), Math.max(0, ...margins)];
  if (judged.length === 0 || low === high) {
    return [];
  }
  const width = (high - low) / count;
  const start = -Math.ceil(-low / width - 1e-9) * width;
  const bins = Array.from({ length: Math.ceil((high - start) / width - 1e-9) }, (_, number) => {
    const from = start + number * width;
    return { from, to: from + width, count: 0, index: -1, worst: Infinity };
  });
  for (const outcome of judged) {
    const value = margin(outcome);
    const bin = bins[Math.min(bins.length - 1, Math.max(0, Math.floor((value - start) / width + 1e-9)))];
    if (bin !== undefined) {
      bin.count += 1;
      if (value < bin.worst) {
        bin.worst = value;
        bin.index = outcome.index;
      }
    }
  }
  return bins.map(({ from, to, count: found, index }) => ({ from, to, count: found, index }));
}

function outcomesOf(scenario: JudgedScenario, index: number, clause: string): Outcome[] {
  if (clause === "") {
    return [{ index, verdict: scenario.verdict, robustness: null, unit: "" }];
  }
  return scenario.clauses.filter(({ iri }) => iri === clause).map((found) => ({ ...found, index }));
}

/** Infinite margins are equal. */
function compare(one: number, other: number): number {
  return one === other ? 0 : one - other;
}

function margin({ robustness }: Outcome): number {
  return robustness ?? Infinity;
}

function ordered(values: readonly string[]): string[] {
  const numbers = values.every((value) => value !== "" && Number.isFinite(Number(value)));
  return numbers ? [...values].sort((one, other) => Number(one) - Number(other)) : [...values];
}
