// A tree of tests without an editor, a server with one file, and a run that records its messages.
import assert from "node:assert/strict";
import type { Sink } from "../src/testing/follower";
import type { Factory, Item, Items } from "../src/testing/items";
import type { Ask, ListedTest, Listing, Place } from "../src/testing/listing";
import { TestTree } from "../src/testing/tree";

export const FILE = "file:///cell/fetch.bdd";
export const SCENE = "file:///cell/cell.scene";

/** A test item without an editor. */
export class Node implements Item<Node> {
  readonly children = new Nodes(this);
  parent: Node | undefined;
  description?: string;
  sortText?: string | undefined;
  busy = false;
  canResolveChildren = false;
  place: Place | null = null;
  problem: string | undefined;

  constructor(
    readonly id: string,
    public label: string,
  ) {}
}

export class Nodes implements Items<Node> {
  private readonly entries = new Map<string, Node>();

  constructor(private readonly owner?: Node) {}

  get size(): number {
    return this.entries.size;
  }

  add(item: Node): void {
    item.parent = this.owner;
    this.entries.set(item.id, item);
  }

  delete(id: string): void {
    this.entries.delete(id);
  }

  get(id: string): Node | undefined {
    return this.entries.get(id);
  }

  replace(items: readonly Node[]): void {
    this.entries.clear();
    items.forEach((item) => {
      this.add(item);
    });
  }

  [Symbol.iterator](): Iterator<[string, Node]> {
    return this.entries[Symbol.iterator]();
  }
}

export const factory: Factory<Node> = {
  create: (id, label) => new Node(id, label),
  setPlace: (item, place) => {
    item.place = place;
  },
  setProblem: (item, problem) => {
    item.problem = problem;
  },
};

export const at = (line: number, uri = FILE): Place => ({
  uri,
  range: { start: { line, character: 0 }, end: { line, character: 9 } },
});

export const clause = (name: string): ListedTest => ({
  kind: "clause",
  id: `t:${name}`,
  name,
  detail: `cube is ${name}`,
  role: "then",
  place: at(3),
  tests: [],
});

export const scenario = (number: number): ListedTest => ({
  kind: "scenario",
  id: String(number),
  name: `part = cube${number}`,
  detail: `scenario ${number}`,
  number,
  place: null,
  tests: [clause("held"), clause("placed")],
});

export const variant = (name: string, count: number, digest = "1"): ListedTest => ({
  kind: "variant",
  id: `t:${name}`,
  name,
  detail: `${count} scenarios`,
  count,
  digest,
  place: at(9),
  variation: at(12),
  tests: [],
});

export const story = (...tests: ListedTest[]): ListedTest => ({
  kind: "story",
  id: "t:tidy",
  name: "tidy",
  detail: "order",
  place: at(7),
  tests,
});

/** A server with one file, whose stories can be changed; it counts the questions. */
export class World {
  readonly roots = new Nodes();
  readonly outdated: string[] = [];
  readonly asked: string[] = [];
  stories: ListedTest[] = [story(variant("fetch", 3), variant("sort", 1000))];
  files = [FILE];
  /** Contents of a file apart from the stories. */
  readonly others: Record<string, ListedTest[]> = {};
  problem: string | null = null;

  readonly ask: Ask = async (question): Promise<Listing> => {
    this.asked.push(question.variant ?? question.uri ?? "files");
    await Promise.resolve();
    if (question.uri === undefined) {
      return { problem: null, files: this.files, tests: [] };
    }
    if (question.variant === undefined) {
      return { problem: null, files: [FILE, SCENE], tests: this.others[question.uri] ?? this.stories };
    }
    const count = this.stories.flatMap((one) => one.tests).find((one) => one.id === question.variant)?.count ?? 0;
    const tests = this.problem === null ? Array.from({ length: count }, (_, index) => scenario(index + 1)) : [];
    const { first = 1, most = count } = question;
    return { problem: this.problem, files: [FILE], tests: tests.slice(first - 1, first - 1 + most) };
  };

  readonly tree = new TestTree<Node>(this.roots, factory, this.ask, (items) => {
    this.outdated.push(...items.map((item) => item.label));
  });

  item(...path: string[]): Node {
    let items: Items<Node> = this.roots;
    let found: Node | undefined;
    for (const label of path) {
      found = [...items].map(([, item]) => item).find((item) => item.label === label);
      assert.ok(found, `there is no ${label}`);
      items = found.children;
    }
    assert.ok(found);
    return found;
  }

  labels(item?: Node): string[] {
    return [...(item?.children ?? this.roots)].map(([, child]) => child.label);
  }
}

export const words = (name: string, position: number) => ({
  clause: `t:${name}`,
  position,
  name,
  role: "then" as const,
  sentence: `cube is ${name}`,
  source: at(3),
});

/** A run that records its messages. */
export function recorded(): { calls: string[]; sink: Sink<Node> } {
  const calls: string[] = [];
  const label = (item: Node) => `${item.parent?.label ?? ""} / ${item.label}`;
  const sink: Sink<Node> = {
    started: (item) => calls.push(`started ${label(item)}`),
    passed: (item, duration) => calls.push(`passed ${label(item)} ${duration ?? "?"}`),
    failed: (item, { text }, place) =>
      calls.push(`failed ${label(item)} ${text} @${place?.range.start.line ?? "?"}`),
    errored: (item, failure) => calls.push(`errored ${label(item)} ${failure.text}`),
    skipped: (item) => calls.push(`skipped ${label(item)}`),
    output: () => undefined,
    end: () => calls.push("end"),
  };
  return { calls, sink };
}
