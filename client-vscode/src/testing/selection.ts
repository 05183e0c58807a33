// What of a tree of tests is to be run, in the words of the server's command.
import type { Facts, Item, Items } from "./items";

/** Scenarios of one variant by their numbers; all where none are named. */
export interface Wanted {
  readonly variant: string;
  readonly variations?: readonly number[];
}

/** Runs of a whole file have no `only`. */
export interface FileRun {
  readonly uri: string;
  readonly only: readonly Wanted[];
}

interface Numbers {
  whole: boolean;
  readonly numbers: Set<number>;
}

/**
 * The runs that execute the included items without the excluded ones, file by file.
 *
 * A clause is judged with its scenario, so that it stands for the scenario; excluded alone it changes nothing.
 * `scenarios` lists the numbers of a variant that is excluded in part.
 */
export function fileRuns<I extends Item<I>>(
  roots: Items<I>,
  about: (item: I) => Facts | undefined,
  include: readonly I[] | undefined,
  exclude: readonly I[],
): FileRun[] {
  const wanted = new Map<string, Map<string, Numbers>>();
  const counts = new Map<string, number>();
  const excluded = new Set(exclude);
  for (const item of include ?? [...roots].map(([, root]) => root)) {
    add(item);
  }
  for (const item of exclude) {
    remove(item);
  }
  return [...wanted].flatMap(([uri, variants]) => {
    const only = [...variants].flatMap(([variant, { whole, numbers }]) => {
      if (whole) {
        return [{ variant }];
      }
      return numbers.size === 0 ? [] : [{ variant, variations: [...numbers].sort((a, b) => a - b) }];
    });
    return only.length === 0 ? [] : [{ uri, only }];
  });

  function add(item: I): void {
    const facts = about(item);
    if (facts === undefined || excluded.has(item)) {
      return;
    }
    if (facts.kind === "story") {
      for (const [, child] of item.children) {
        add(child);
      }
      return;
    }
    const found = numbersOf(facts);
    if (facts.kind === "variant") {
      found.whole = true;
      counts.set(facts.variant ?? "", facts.count ?? 0);
    } else {
      found.numbers.add(facts.number ?? 0);
    }
  }

  function remove(item: I): void {
    const facts = about(item);
    const found = facts === undefined ? undefined : wanted.get(facts.uri)?.get(facts.variant ?? "");
    if (facts?.number === undefined || facts.kind !== "scenario" || found === undefined) {
      return;
    }
    if (found.whole) {
      // What is left of a whole variant has to be named.
      found.whole = false;
      const count = counts.get(facts.variant ?? "") ?? 0;
      for (let number = 1; number <= count; number += 1) {
        found.numbers.add(number);
      }
    }
    found.numbers.delete(facts.number);
  }

  function numbersOf(facts: Facts): Numbers {
    const variants = wanted.get(facts.uri) ?? new Map<string, Numbers>();
    wanted.set(facts.uri, variants);
    const found = variants.get(facts.variant ?? "") ?? { whole: false, numbers: new Set<number>() };
    variants.set(facts.variant ?? "", found);
    return found;
  }
}
