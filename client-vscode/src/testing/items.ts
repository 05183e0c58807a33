// The part of the editor's test items that the tree uses, so that it can be tested without an editor.
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

/** Creates items and sets the fields that need the editor's own types. */
export interface Factory<I> {
  create(id: string, label: string, uri: string): I;
  setPlace(item: I, place: Place | null): void;
  setProblem(item: I, problem: string | undefined): void;
}

/** The source of scenarios: a plain variant, or an execution of it; both by IRI. */
export interface Source {
  readonly variant: string;
  readonly execution?: string | undefined;
}

/** The data behind an item; `uri` is the model that is run. */
export interface Facts extends Partial<Source> {
  /** `more` represents scenarios that are not listed yet. */
  readonly kind: Kind | "more";
  readonly uri: string;
  readonly place: Place | null;
  /** Of a variant or an execution: its number of scenarios, if known. */
  readonly count?: number | undefined;
  readonly digest?: string | undefined;
  /** Of a variant or an execution: small enough to list its values at once and show them next to the text. */
  readonly small?: boolean;
  readonly variation?: Place | null;
  /** Of a scenario and its clauses. */
  readonly number?: number;
  /** Of a clause: its IRI, and its text within the scenario. */
  readonly clause?: string;
  readonly detail: string;
}
