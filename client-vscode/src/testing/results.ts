// Show results of earlier or external runs as a finished run.
import type * as answers from "../answers/testresults";
import type { Immutable } from "../immutable";
import { type Sink, showOutcome } from "./follower";
import type { Item } from "./items";
import type { ListedTest } from "./listing";
import { type Outcome, failureOf, folded, inFailed } from "./outcomes";
import type { TestTree } from "./tree";
import { Worst } from "./worst";

export { isFoundResults } from "../answers/validators.mjs";

export type FoundScenario = Immutable<answers.Scenario>;
export type FoundClause = Immutable<answers.Clause>;
/** The answer to the server's requests `robbdd/testResults` and `robbdd/importResults`. */
export type FoundResults = Immutable<answers.FoundResults>;

export interface Shown<I> {
  /** Items whose text has changed since. */
  readonly outdated: readonly I[];
  /** Results of scenarios that are not listed yet, with clauses that only the list can identify. */
  readonly left: readonly FoundScenario[];
}

/** Show results at the items of the tree. */
export async function showResults<I extends Item<I>>(
  tree: TestTree<I>,
  scenarios: readonly FoundScenario[],
  sink: Sink<I>,
): Promise<Shown<I>> {
  const outdated: I[] = [];
  const left: FoundScenario[] = [];
  const worst = new Worst<I>();
  for (const found of scenarios) {
    const variant = await listed(tree, found);
    if (variant === undefined) {
      continue;
    }
    if (!tree.lists(variant, found.variation) && found.clauses.some(({ position }) => position === null)) {
      left.push(found);
      continue;
    }
    const scenario = tree.scenario(variant, found.variation, found.values);
    const whole = found.seconds === null ? undefined : found.seconds * 1000;
    const failed = found.clauses.some(({ verdict }) => verdict === "violated");
    for (const clause of found.clauses) {
      for (const item of itemsOf(tree, scenario, clause)) {
        // Only whole executions are timed: each clause gets an equal share, so that the sum is right.
        const share = whole === undefined ? undefined : whole / found.clauses.length;
        const own = folded(outcomeOf(clause, found.values), clause.because, isCauseShown(clause, found.clauses));
        const outcome = worst.add(item, failed ? inFailed(own) : own);
        tree.note(item, outcome.note);
        showOutcome(sink, item, outcome, tree.about(item)?.place ?? null, share);
        if (found.stale || clause.stale) {
          outdated.push(item);
        }
      }
    }
  }
  return { outdated, left };
}

/** The variant of an execution with its scenarios, undefined if the workspace no longer has it. */
async function listed<I extends Item<I>>(tree: TestTree<I>, found: FoundScenario): Promise<I | undefined> {
  if (!tree.knows(found.uri)) {
    await tree.load(found.uri);
  }
  const variant = tree.source(found.uri, { variant: found.variant, execution: found.execution ?? undefined });
  if (variant?.children.size === 0) {
    await tree.expand(variant);
  }
  return variant;
}

function itemsOf<I extends Item<I>>(tree: TestTree<I>, scenario: I, found: FoundClause): I[] {
  if (found.position === null) {
    return [...tree.clauses(scenario)].filter((item) => tree.about(item)?.clause === found.clause);
  }
  const written: ListedTest = {
    kind: "clause",
    id: found.clause ?? "",
    name: found.sentence,
    detail: "",
    place: null,
    tests: [],
  };
  return [tree.clause(scenario, found.position, written)];
}

/** Whether the cause of a clause is one of these, with a failure or an error of its own. */
function isCauseShown({ because }: FoundClause, clauses: readonly FoundClause[]): boolean {
  const isCause = ({ clause, position }: FoundClause) =>
    because?.position === null ? clause === because.clause : position === because?.position;
  return clauses.some((one) => isCause(one) && one.verdict !== "holds" && one.because === null);
}

function outcomeOf(found: FoundClause, values: string): Outcome {
  switch (found.verdict) {
    case "holds":
      return { state: "passed", note: found.margin };
    case "violated":
      return { state: "failed", note: found.margin || found.failure, failure: failureOf(found, values) };
    case "unknown":
      return { state: "errored", note: found.failure, failure: failureOf(found, values) };
  }
}
