// What runs before or elsewhere have found, shown as a finished run.
import { isRecord } from "../values";
import type { Sink } from "./follower";
import type { Item } from "./items";
import type { ListedTest } from "./listing";
import { type Failure, NO_LESS } from "./outcomes";
import type { TestTree } from "./tree";

export interface FoundClause {
  /** IRI, or the number of the clause in its scenario from 0; one of both is told. */
  readonly clause: string | null;
  readonly position: number | null;
  readonly sentence: string;
  readonly verdict: "holds" | "violated" | "unknown";
  readonly margin: string;
  /** Sign, margin, instant and reason. */
  readonly said: string;
  readonly stale: boolean;
}

export interface FoundScenario {
  readonly uri: string;
  readonly variant: string;
  readonly variation: number;
  readonly values: string;
  readonly seconds: number | null;
  readonly stale: boolean;
  readonly clauses: readonly FoundClause[];
}

/** The answer to the server's requests `robbdd/testResults` and `robbdd/importResults`. */
export interface FoundResults {
  readonly problem: string | null;
  /** Executions of variants that the workspace does not have. */
  readonly left: number;
  readonly scenarios: readonly FoundScenario[];
}

/** Whether an answer is one that this extension understands. */
export function isFoundResults(value: unknown): value is FoundResults {
  return isRecord(value) && typeof value["left"] === "number" && Array.isArray(value["scenarios"]);
}

/** Put results onto the items of the tree; returns the items whose text has changed since. */
export async function showResults<I extends Item<I>>(
  tree: TestTree<I>,
  scenarios: readonly FoundScenario[],
  sink: Sink<I>,
): Promise<I[]> {
  const outdated: I[] = [];
  for (const found of scenarios) {
    const variant = await listed(tree, found);
    if (variant === undefined) {
      continue;
    }
    const scenario = tree.scenario(variant, found.variation, found.values);
    const whole = found.seconds === null ? undefined : found.seconds * 1000;
    for (const clause of found.clauses) {
      for (const item of itemsOf(tree, scenario, clause)) {
        // Only the whole execution was timed: each clause takes its share, so that the sum is right.
        show(tree, sink, item, clause, found.values, whole === undefined ? undefined : whole / found.clauses.length);
        if (found.stale || clause.stale) {
          outdated.push(item);
        }
      }
    }
  }
  return outdated;
}

/** The variant of an execution with its scenarios, undefined where the workspace does not have it any more. */
async function listed<I extends Item<I>>(tree: TestTree<I>, found: FoundScenario): Promise<I | undefined> {
  if (!tree.knows(found.uri)) {
    await tree.load(found.uri);
  }
  const variant = tree.variant(found.uri, found.variant);
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

function show<I extends Item<I>>(
  tree: TestTree<I>,
  sink: Sink<I>,
  item: I,
  found: FoundClause,
  values: string,
  duration: number | undefined,
): void {
  tree.note(item, found.margin);
  const text = `${found.said}${values === "" ? "" : ` [${values}]`}`;
  const place = tree.about(item)?.place ?? null;
  switch (found.verdict) {
    case "holds":
      sink.passed(item, duration);
      break;
    case "violated":
      sink.failed(item, { text, ...compared(found) }, place, duration);
      break;
    case "unknown":
      sink.errored(item, { text }, place, duration);
      break;
  }
}

/** As short as that of a run of our own, so that it fits beside the clause: without sign and reason. */
function compared({ margin, said }: FoundClause): Omit<Failure, "text"> {
  const actual = said.replace(/^\S+ /, "").split(": ", 1)[0] ?? margin;
  return margin === "" ? {} : { expected: NO_LESS, actual };
}
