// Answers of the server's request `robbdd/tests`, level by level.
import { isRecord } from "../values";

/** A place in a text, in the units of the protocol, which are those of the editor. */
export interface Place {
  readonly uri: string;
  readonly range: {
    readonly start: { readonly line: number; readonly character: number };
    readonly end: { readonly line: number; readonly character: number };
  };
}

export type Kind = "file" | "story" | "variant" | "execution" | "scenario" | "clause";

export interface ListedTest {
  readonly kind: Kind;
  /** IRI; for a scenario its number, for a file its address. */
  readonly id: string;
  readonly name: string;
  readonly detail: string;
  readonly place: Place | null;
  readonly tests: readonly ListedTest[];
  /** Of an execution: IRI of the variant that it executes. */
  readonly variant?: string;
  /** Of a variant or an execution: its number of scenarios, if known. */
  readonly count?: number | null;
  /** Of a variant or an execution: the place of its values. */
  readonly variation?: Place | null;
  /** Of a variant or an execution: changes with its text and that of the declarations it names. */
  readonly digest?: string;
  /** Of a scenario. */
  readonly number?: number;
  /** Of a clause. */
  readonly role?: string;
}

export interface Listing {
  /** Why there is nothing (more) to show, for the user. */
  readonly problem: string | null;
  /** Files with stories, or the files that the answer depends on. */
  readonly files: readonly string[];
  readonly tests: readonly ListedTest[];
}

/**
 * The request's parameters: without any, the files; with `uri`, the stories of one; with `variant`, the scenarios of a
 * variant.
 */
export interface Question {
  readonly uri?: string;
  readonly variant?: string;
  readonly first?: number;
  readonly most?: number;
}

export type Ask = (question: Question) => Promise<Listing | undefined>;

const KINDS: ReadonlySet<unknown> = new Set<Kind>(["file", "story", "variant", "execution", "scenario", "clause"]);

/** Whether an answer is understood by this version of the extension. */
export function isListing(value: unknown): value is Listing {
  return (
    isRecord(value) &&
    (value["problem"] === null || typeof value["problem"] === "string") &&
    isListOf(value["files"], (file) => typeof file === "string") &&
    isListOf(value["tests"], isTest)
  );
}

function isTest(value: unknown): boolean {
  return (
    isRecord(value) &&
    KINDS.has(value["kind"]) &&
    ["id", "name", "detail"].every((name) => typeof value[name] === "string") &&
    (value["place"] === null || isPlace(value["place"])) &&
    isListOf(value["tests"], isTest)
  );
}

/** Whether a value is a place in a text. */
export function isPlace(value: unknown): value is Place {
  return isRecord(value) && typeof value["uri"] === "string" && isRecord(value["range"]);
}

function isListOf(value: unknown, check: (entry: unknown) => boolean): boolean {
  return Array.isArray(value) && value.every(check);
}
