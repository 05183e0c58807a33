// Answers of the server's request `robbdd/tests`, level by level.
import type * as answers from "../answers/tests";
import type { Immutable } from "../immutable";
import { isRecord } from "../values";

/** A place in a text, in the units of the protocol, which are those of the editor. */
export interface Place {
  readonly uri: string;
  readonly range: {
    readonly start: { readonly line: number; readonly character: number };
    readonly end: { readonly line: number; readonly character: number };
  };
}

export { isListing } from "../answers/validators.mjs";

export type Listing = Immutable<answers.Listing>;
export type ListedTest = Immutable<answers.Test>;
export type Kind = ListedTest["kind"];

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

/** Whether a value is a place in a text. */
export function isPlace(value: unknown): value is Place {
  return isRecord(value) && typeof value["uri"] === "string" && isRecord(value["range"]);
}
