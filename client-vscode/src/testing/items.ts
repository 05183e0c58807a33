// The part of the editor's test items that the tree needs, so that it can be tested without an editor.
import type { Kind, Place } from "./listing";

export interface Items<I> extends Iterable<[id: string, item: I]> {
  readonly size: number;
  add(item: I): void;
  delete(id: string): void;
  get(id: string): I | undefined;
  replace(items: readonly I[]): void;
}

export interface Item<I> {
  readonly id: string;
  readonly children: Items<I>;
  readonly parent: I | undefined;
  label: string;
  description?: string;
  sortText?: string | undefined;
  busy: boolean;
  canResolveChildren: boolean;
}

/** Makes items and sets what the editor has types of its own for. */
export interface Factory<I> {
  create(id: string, label: string, uri: string): I;
  setPlace(item: I, place: Place | null): void;
  setProblem(item: I, problem: string | undefined): void;
}

/** What makes scenarios: a variant as it is, or as an execution of it says; both by IRI. */
export interface Source {
  readonly variant: string;
  readonly execution?: string | undefined;
}

/** What an item stands for; `uri` is the model that is run. */
export interface Facts extends Partial<Source> {
  /** `more` stands for scenarios that are not listed yet. */
  readonly kind: Kind | "more";
  readonly uri: string;
  readonly place: Place | null;
  /** Of a variant or an execution: how many scenarios it makes, where known. */
  readonly count?: number | undefined;
  readonly digest?: string | undefined;
  /** Of these: its values are known without a long wait, and are shown beside the text. */
  readonly small?: boolean;
  readonly variation?: Place | null;
  /** Of a scenario and its clauses. */
  readonly number?: number;
  /** Of a clause: its IRI, and what it says of its scenario. */
  readonly clause?: string;
  readonly detail: string;
}
