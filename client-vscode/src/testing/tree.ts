// The test tree: stories, variants, executions, scenarios, clauses; it is loaded on demand and follows the text.
import * as words from "./facts";
import type { Facts, Factory, Item, Items, Source } from "./items";
import type { Ask, ListedTest, Listing, Place } from "./listing";
import type { Wanted } from "./selection";

/** Maximum number of scenarios in one answer of the server. */
const MOST = 10_000;

export class TestTree<I extends Item<I>> {
  private readonly facts = new WeakMap<I, Facts>();
  /** The last run's result, as a short note. */
  private readonly notes = new WeakMap<I, string>();
  /** For each file with stories, the files that its tests depend on. */
  private readonly files = new Map<string, ReadonlySet<string>>();
  /** Number of listed scenarios by variant. */
  private readonly listed = new WeakMap<I, number>();
  /** Loads in progress, so that nothing is loaded twice at a time. */
  private readonly loading = new Map<string, Promise<void>>();

  /** `outdated` is called with items whose text has changed since it was listed. */
  constructor(
    private readonly roots: Items<I>,
    private readonly factory: Factory<I>,
    private readonly ask: Ask,
    private readonly outdated: (items: readonly I[]) => void,
  ) {}

  about(item: I): Facts | undefined {
    return this.facts.get(item);
  }

  /** Find the files with stories, and their contents. */
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

  /** Load the stories of a file, also if already known. */
  load(uri: string): Promise<void> {
    return this.once(uri, async () => {
      const found = await this.ask({ uri });
      if (found !== undefined) {
        this.files.set(uri, new Set(found.files));
        this.place(uri, found);
      }
    });
  }

  /** List the children of an item; the root without an item. */
  async expand(item: I | undefined): Promise<void> {
    const facts = item === undefined ? undefined : this.facts.get(item);
    if (item === undefined || facts === undefined) {
      await this.discover();
    } else if (words.makesScenarios(facts)) {
      await this.expandVariant(item);
    } else if (facts.kind === "more" && item.parent !== undefined) {
      const listed = this.listed.get(item.parent) ?? 0;
      await this.list(item.parent, listed + 1, listed + Math.min(listed, MOST));
    }
  }

  /** Whether a scenario is listed. */
  lists(variant: I, number: number): boolean {
    return number <= (this.listed.get(variant) ?? 0);
  }

  /** List the scenarios of a file's small variants, and of those already listed. */
  async expandSmall(uri: string): Promise<void> {
    for (const item of this.variantsOf(uri)) {
      const facts = this.facts.get(item);
      if (facts !== undefined && (facts.small === true || item.children.size > 0)) {
        await this.expandVariant(item);
      }
    }
  }

  /** The known files whose tests depend on a file, including the file itself. */
  dependents(uri: string): string[] {
    return [...this.files].filter(([file, needs]) => file === uri || needs.has(uri)).map(([file]) => file);
  }

  /** Load the files again whose tests a run of a file may have executed: the pass rates of variants may have changed. */
  async refresh(uri: string): Promise<void> {
    for (const file of new Set([uri, ...(this.files.get(uri) ?? [])])) {
      if (this.knows(file)) {
        await this.load(file);
      }
    }
  }

  knows(uri: string): boolean {
    return this.files.has(uri);
  }

  forget(uri: string): void {
    this.files.delete(uri);
    this.drop(this.roots, (facts) => facts.uri === uri, new Set());
  }

  /** The item of a variant, or of an execution of one. */
  source(uri: string, source: Source): I | undefined {
    return this.variantsOf(uri).find((item) => words.sameSource(this.facts.get(item) ?? {}, source));
  }

  /** The listed scenarios among those wanted of a variant. */
  scenariosOf(uri: string, { variations, ...source }: Wanted): I[] {
    const scenarios = [...(this.source(uri, source)?.children ?? [])].map(([, item]) => item);
    return scenarios.filter((item) => variations?.includes(this.facts.get(item)?.number ?? 0) ?? true);
  }

  /** The wanted items of a variant: the variant as a whole, or some of its scenarios. */
  wanted(uri: string, wanted: Wanted): I[] {
    const whole = this.source(uri, wanted);
    return wanted.variations === undefined && whole !== undefined ? [whole] : this.scenariosOf(uri, wanted);
  }

  /** The item of a scenario; an unlisted one is created with the data of its run. */
  scenario(variant: I, number: number, name: string): I {
    const facts = this.facts.get(variant);
    const found = variant.children.get(String(number));
    return (
      found ??
      this.put(variant.children, facts?.uri ?? "", facts, {
        kind: "scenario",
        id: String(number),
        name,
        detail: `scenario ${number}`,
        place: null,
        tests: [],
        number,
      })
    );
  }

  /** The item of a clause by its position in the scenario; an unlisted one is created. */
  clause(scenario: I, position: number, listed: ListedTest): I {
    const facts = this.facts.get(scenario);
    return (
      scenario.children.get(String(position)) ??
      this.put(scenario.children, facts?.uri ?? "", facts, listed, position)
    );
  }

  /** Show a run's result after an item's name. */
  note(item: I, note: string): void {
    this.notes.set(item, note);
    item.description = words.described(note, this.facts.get(item)?.detail ?? "");
  }

  /** The listed clauses below an item, or the item itself if it is one. */
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

  /** List the first scenarios of a variant, as many as are already listed. */
  private async expandVariant(item: I): Promise<void> {
    await this.list(item, 1, Math.min(MOST, Math.max(words.PAGE, this.listed.get(item) ?? 0)));
  }

  private async list(item: I, first: number, last: number): Promise<void> {
    const { uri = "", variant = "", execution } = this.facts.get(item) ?? {};
    await this.once(`${uri} ${execution ?? variant}`, async () => {
      item.busy = true;
      try {
        const found = await this.ask({ uri, variant, first, most: last - first + 1 });
        if (found !== undefined) {
          this.factory.setProblem(item, found.problem ?? undefined);
          // Keep the list while the text has errors: results refer to it.
          if (found.problem === null) {
            this.fill(item, found.tests, first, last);
          }
        }
      } finally {
        item.busy = false;
      }
    });
  }

  private fill(item: I, scenarios: readonly ListedTest[], first: number, last: number): void {
    const owner = this.facts.get(item);
    const ended = scenarios.length <= last - first || last === owner?.count;
    const kept = new Set<string>();
    for (const listed of scenarios) {
      const scenario = this.put(item.children, owner?.uri ?? "", owner, listed);
      kept.add(scenario.id);
      const clauses = listed.tests.map((clause, position) =>
        this.put(scenario.children, owner?.uri ?? "", this.facts.get(scenario), clause, position),
      );
      this.drop(scenario.children, () => true, new Set(clauses.map((clause) => clause.id)));
    }
    // Keep scenarios that a run has added further down, if they still exist.
    const isAmong = ({ number = 0 }: Facts) => number >= first && (ended || number <= last);
    this.drop(item.children, (facts) => facts.kind === "more" || isAmong(facts), kept);
    this.listed.set(item, first - 1 + scenarios.length);
    if (!ended) {
      this.addMore(item, last);
    }
  }

  /** Add an item that lists more scenarios when expanded. */
  private addMore(variant: I, listed: number): void {
    const { uri = "", count } = this.facts.get(variant) ?? {};
    const { label, description } = words.moreWords(listed, count);
    const item = this.factory.create(`more-${listed}`, label, uri);
    this.facts.set(item, { kind: "more", uri, place: null, detail: description });
    item.description = description;
    item.sortText = "z";
    item.canResolveChildren = true;
    variant.children.add(item);
  }

  /** Create or update the item of a listed test; the item's identity is kept, so that it keeps its results. */
  private put(into: Items<I>, uri: string, owner: Facts | undefined, listed: ListedTest, position?: number): I {
    const id = words.itemId(uri, listed, position);
    let item = into.get(id);
    const before = item === undefined ? undefined : this.facts.get(item);
    const facts = words.factsOf(uri, owner, listed);
    if (item === undefined) {
      item = this.factory.create(id, words.labelOf(listed), owner?.execution === undefined ? (listed.place?.uri ?? uri) : uri);
      this.facts.set(item, facts);
      into.add(item);
    } else if (before !== undefined && words.hasChanged(before, facts)) {
      this.outdated([item]);
      this.notes.delete(item);
    }
    this.facts.set(item, facts);
    item.label = words.labelOf(listed);
    item.description = words.described(this.notes.get(item) ?? "", facts.detail);
    item.sortText = words.sortOf(listed, position);
    item.canResolveChildren = words.makesScenarios(facts);
    this.factory.setPlace(item, this.placeOf(facts, owner));
    return item;
  }

  /** Where an item is shown: clauses and rows in the text run the plain variant, not its executions. */
  private placeOf({ kind, place }: Facts, owner: Facts | undefined): Place | null {
    if (owner?.execution !== undefined) {
      return null;
    }
    return place ?? (kind === "scenario" ? (owner?.variation ?? null) : null);
  }

  private drop(from: Items<I>, among: (facts: Facts) => boolean, kept: ReadonlySet<string>): void {
    for (const [id, item] of [...from]) {
      const facts = this.facts.get(item);
      if (!kept.has(id) && facts !== undefined && among(facts)) {
        from.delete(id);
      }
    }
  }

  /** Serialise a slow task: a request during its execution repeats it once more afterwards. */
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
