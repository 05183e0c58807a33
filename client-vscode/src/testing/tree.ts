// The tree of tests: stories, variants, scenarios, clauses; it grows as it is asked for and follows the text.
import type { Facts, Factory, Item, Items } from "./items";
import type { Ask, ListedTest, Listing, Place } from "./listing";
import type { Wanted } from "./selection";

/** Scenarios of a variant that are listed before anybody asks, so that rows and clauses have icons of their own. */
export const EAGER = 100;

export class TestTree<I extends Item<I>> {
  private readonly facts = new WeakMap<I, Facts>();
  /** What the last run found, in a word or two. */
  private readonly notes = new WeakMap<I, string>();
  /** For each file with stories the files that its tests depend on. */
  private readonly files = new Map<string, ReadonlySet<string>>();
  /** What is being read, so that nothing is read twice at a time. */
  private readonly loading = new Map<string, Promise<void>>();

  /** `outdated` is told of items whose text has changed since it was listed. */
  constructor(
    private readonly roots: Items<I>,
    private readonly factory: Factory<I>,
    private readonly ask: Ask,
    private readonly outdated: (items: readonly I[]) => void,
  ) {}

  about(item: I): Facts | undefined {
    return this.facts.get(item);
  }

  /** Find the files with stories, and what they tell. */
  async discover(): Promise<void> {
    const found = await this.ask({});
    if (found === undefined) {
      return;
    }
    for (const uri of this.files.keys()) {
      if (!found.files.includes(uri)) {
        this.forget(uri);
      }
    }
    for (const uri of found.files) {
      await this.load(uri);
    }
  }

  /** Read the stories of a file, again if it is known. */
  load(uri: string): Promise<void> {
    return this.once(uri, async () => {
      const found = await this.ask({ uri });
      if (found !== undefined) {
        this.files.set(uri, new Set(found.files));
        this.place(uri, found);
      }
    });
  }

  /** List what is below an item; everything where there is none. */
  async expand(item: I | undefined): Promise<void> {
    const facts = item === undefined ? undefined : this.facts.get(item);
    if (item === undefined || facts === undefined) {
      await this.discover();
    } else if (facts.kind === "variant") {
      await this.expandVariant(item, facts);
    }
  }

  /** List the scenarios of a file's variants that have only few, and of those that are listed already. */
  async expandSmall(uri: string): Promise<void> {
    for (const item of this.variantsOf(uri)) {
      const facts = this.facts.get(item);
      if (facts !== undefined && (facts.small === true || item.children.size > 0)) {
        await this.expandVariant(item, facts);
      }
    }
  }

  /** The known files whose tests depend on a file, and the file itself if it is known. */
  dependents(uri: string): string[] {
    return [...this.files].filter(([file, needs]) => file === uri || needs.has(uri)).map(([file]) => file);
  }

  knows(uri: string): boolean {
    return this.files.has(uri);
  }

  forget(uri: string): void {
    this.files.delete(uri);
    this.drop(this.roots, (facts) => facts.uri === uri, new Set());
  }

  variant(uri: string, iri: string): I | undefined {
    return this.variantsOf(uri).find((item) => this.facts.get(item)?.variant === iri);
  }

  /** The listed scenarios that are wanted of a variant. */
  scenariosOf(uri: string, { variant, variations }: Wanted): I[] {
    const scenarios = [...(this.variant(uri, variant)?.children ?? [])].map(([, item]) => item);
    return scenarios.filter((item) => variations?.includes(this.facts.get(item)?.number ?? 0) ?? true);
  }

  /** What is wanted of a variant: the variant as a whole, or those of its scenarios. */
  wanted(uri: string, wanted: Wanted): I[] {
    const whole = this.variant(uri, wanted.variant);
    return wanted.variations === undefined && whole !== undefined ? [whole] : this.scenariosOf(uri, wanted);
  }

  /** The item of a scenario; one that was not listed yet is made with the words of its run. */
  scenario(variant: I, number: number, words: string): I {
    const facts = this.facts.get(variant);
    const found = variant.children.get(String(number));
    return (
      found ??
      this.put(variant.children, facts?.uri ?? "", facts, {
        kind: "scenario",
        id: String(number),
        name: words,
        detail: `scenario ${number}`,
        place: null,
        tests: [],
        number,
      })
    );
  }

  /** The item of a clause by its position in the scenario; one that was not listed yet is made. */
  clause(scenario: I, position: number, listed: ListedTest): I {
    const facts = this.facts.get(scenario);
    return (
      scenario.children.get(String(position)) ??
      this.put(scenario.children, facts?.uri ?? "", facts, listed, position)
    );
  }

  /** Show what a run found behind an item's name. */
  note(item: I, note: string): void {
    this.notes.set(item, note);
    item.description = described(note, this.facts.get(item)?.detail ?? "");
  }

  /** The clauses below an item that are listed, the item itself where it is one. */
  *clauses(item: I): Generator<I> {
    if (this.facts.get(item)?.kind === "clause") {
      yield item;
    }
    for (const [, child] of item.children) {
      yield* this.clauses(child);
    }
  }

  private *stories(uri: string): Generator<I> {
    for (const [, item] of this.roots) {
      if (this.facts.get(item)?.uri === uri) {
        yield item;
      }
    }
  }

  variantsOf(uri: string): I[] {
    return [...this.stories(uri)].flatMap((story) => [...story.children].map(([, item]) => item));
  }

  private place(uri: string, found: Listing): void {
    const kept = new Set<string>();
    for (const story of found.tests) {
      const item = this.put(this.roots, uri, undefined, story);
      kept.add(item.id);
      const variants = new Set<string>();
      for (const variant of story.tests) {
        variants.add(this.put(item.children, uri, undefined, variant).id);
      }
      this.drop(item.children, () => true, variants);
    }
    this.drop(this.roots, (facts) => facts.uri === uri, kept);
  }

  private async expandVariant(item: I, facts: Facts): Promise<void> {
    const variant = facts.variant ?? "";
    await this.once(`${facts.uri} ${variant}`, async () => {
      item.busy = true;
      try {
        const found = await this.ask({ uri: facts.uri, variant });
        if (found !== undefined) {
          this.factory.setProblem(item, found.problem ?? undefined);
          // What was listed before a mistake stays: it is what results are about.
          if (found.problem === null) {
            this.fill(item, found.tests);
          }
        }
      } finally {
        item.busy = false;
      }
    });
  }

  private fill(item: I, scenarios: readonly ListedTest[]): void {
    const owner = this.facts.get(item);
    const kept = new Set<string>();
    for (const listed of scenarios) {
      const scenario = this.put(item.children, owner?.uri ?? "", owner, listed);
      kept.add(scenario.id);
      const clauses = listed.tests.map((clause, position) =>
        this.put(scenario.children, owner?.uri ?? "", this.facts.get(scenario), clause, position),
      );
      this.drop(scenario.children, () => true, new Set(clauses.map((clause) => clause.id)));
    }
    this.drop(item.children, () => true, kept);
  }

  /** Make or update the item of a listed test; it stays the same item, so that it keeps its results. */
  private put(into: Items<I>, uri: string, owner: Facts | undefined, listed: ListedTest, position?: number): I {
    const id = itemId(uri, listed, position);
    let item = into.get(id);
    const before = item === undefined ? undefined : this.facts.get(item);
    const facts = factsOf(uri, owner, listed);
    if (item === undefined) {
      item = this.factory.create(id, labelOf(listed), listed.place?.uri ?? uri);
      this.facts.set(item, facts);
      into.add(item);
    } else if (before !== undefined && hasChanged(before, facts)) {
      this.outdated([item]);
      this.notes.delete(item);
    }
    this.facts.set(item, facts);
    item.label = labelOf(listed);
    item.description = described(this.notes.get(item) ?? "", facts.detail);
    item.sortText = sortOf(listed, position);
    item.canResolveChildren = listed.kind === "variant";
    this.factory.setPlace(item, facts.place ?? (listed.kind === "scenario" ? (owner?.variation ?? null) : null));
    return item;
  }

  private drop(from: Items<I>, among: (facts: Facts) => boolean, kept: ReadonlySet<string>): void {
    for (const [id, item] of [...from]) {
      const facts = this.facts.get(item);
      if (!kept.has(id) && facts !== undefined && among(facts)) {
        from.delete(id);
      }
    }
  }

  /** Do something that takes time once at a time: who asks for the same meanwhile gets it done once more, after it. */
  private once(key: string, task: () => Promise<void>): Promise<void> {
    const running = this.loading.get(key);
    const next = (running ?? Promise.resolve()).then(task).finally(() => {
      if (this.loading.get(key) === next) {
        this.loading.delete(key);
      }
    });
    this.loading.set(key, next);
    return next;
  }
}

function described(note: string, detail: string): string {
  return [note, detail].filter((part) => part !== "").join(" · ");
}

function factsOf(uri: string, owner: Facts | undefined, listed: ListedTest): Facts {
  const common = { kind: listed.kind, uri, place: listed.place, detail: listed.detail };
  switch (listed.kind) {
    case "story":
      return { ...common, detail: described(decodeURIComponent(uri.split("/").at(-1) ?? ""), listed.detail) };
    case "variant": {
      const count = listed.count ?? undefined;
      const small = count !== undefined && count <= EAGER;
      const variation: Place | null = listed.variation ?? null;
      return { ...common, variant: listed.id, count, small, variation, digest: listed.digest };
    }
    case "scenario":
      return { ...common, variant: owner?.variant ?? "", number: listed.number ?? Number(listed.id) };
    case "clause":
      return { ...common, variant: owner?.variant ?? "", number: owner?.number ?? 0, clause: listed.id };
  }
}

/** Whether results that an item had are about another text: its words have changed, or those that it stands for. */
function hasChanged(before: Facts, now: Facts): boolean {
  return now.kind === "variant"
    ? before.digest !== now.digest
    : now.kind !== "story" && before.clause !== now.clause;
}

function itemId(uri: string, listed: ListedTest, position?: number): string {
  switch (listed.kind) {
    case "story":
      return `${uri} ${listed.id}`;
    case "variant":
      return listed.id;
    case "scenario":
      return listed.id;
    case "clause":
      return String(position);
  }
}

function labelOf(listed: ListedTest): string {
  const role = listed.role ?? "";
  return role === "" ? listed.name : `${role.charAt(0).toUpperCase()}${role.slice(1)} ${listed.name}`;
}

/** Everything stands in the order of the text: places of stories and variants, numbers of the others. */
function sortOf(listed: ListedTest, position?: number): string {
  const number = position ?? listed.number ?? listed.place?.range.start.line ?? 0;
  return String(number).padStart(9, "0");
}
