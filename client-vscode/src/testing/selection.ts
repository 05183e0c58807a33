// Convert a selection in the test tree to the server's command.
import type { Facts, Item, Items, Source } from "./items";

/** Scenarios of one variant, or of one execution of it, by number; all without numbers. */
export interface Wanted extends Source {
  readonly variations?: readonly number[];
}

/** Runs of a whole file have no `only`. */
export interface FileRun {
  readonly uri: string;
  readonly only: readonly Wanted[];
}

interface Numbers {
  readonly source: Source;
  /** The number of existing scenarios. */
  count: number;
  whole: boolean;
  readonly numbers: Set<number>;
}

/**
 * The runs that execute the included items without the excluded ones, file by file.
 *
 * A clause is judged with its scenario, so it stands for the scenario; excluding only a clause has no effect. If a
 * variant is partly excluded, the others are listed by number.
 */
export function fileRuns<I extends Item<I>>(
  roots: Items<I>,
  about: (item: I) => Facts | undefined,
  include: readonly I[] | undefined,
  exclude: readonly I[],
): FileRun[] {
  const wanted = new Map<string, Map<string, Numbers>>();
  const excluded = new Set(exclude);
  for (const item of include ?? [...roots].map(([, root]) => root)) {
    add(item);
  }
  for (const item of exclude) {
    remove(item);
  }
  return [...wanted].flatMap(([uri, sources]) => {
    const only = [...sources.values()].flatMap(({ source, whole, numbers }) => {
      if (whole) {
        return [source];
      }
      return numbers.size === 0 ? [] : [{ ...source, variations: [...numbers].sort((a, b) => a - b) }];
    });
    return only.length === 0 ? [] : [{ uri, only }];
  });

  function add(item: I): void {
    const facts = about(item);
    if (facts === undefined || excluded.has(item)) {
      return;
    }
    if (facts.variant === undefined) {
      for (const [, child] of item.children) {
        add(child);
      }
      return;
    }
    const found = numbersOf(facts.uri, sourceOf(facts));
    if (facts.number === undefined) {
      found.whole = true;
      found.count = facts.count ?? 0;
    } else {
      found.numbers.add(facts.number);
    }
  }

  function remove(item: I): void {
    const facts = about(item);
    const found = facts === undefined ? undefined : wanted.get(facts.uri)?.get(keyOf(sourceOf(facts)));
    if (facts?.number === undefined || facts.kind !== "scenario" || found === undefined) {
      return;
    }
    if (found.whole) {
      // The rest of a partly excluded variant must be listed.
      found.whole = false;
      for (let number = 1; number <= found.count; number += 1) {
        found.numbers.add(number);
      }
    }
    found.numbers.delete(facts.number);
  }

  function numbersOf(uri: string, source: Source): Numbers {
    const sources = wanted.get(uri) ?? new Map<string, Numbers>();
    wanted.set(uri, sources);
    const found = sources.get(keyOf(source)) ?? { source, count: 0, whole: false, numbers: new Set<number>() };
    sources.set(keyOf(source), found);
    return found;
  }
}

function sourceOf({ variant, execution }: Facts): Source {
  return { variant: variant ?? "", ...(execution === undefined ? {} : { execution }) };
}

function keyOf({ variant, execution }: Source): string {
  return execution ?? variant;
}
