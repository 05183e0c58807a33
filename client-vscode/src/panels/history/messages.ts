// Messages between the extension and the page with the history of a clause.
import type { ClauseHistory } from "./answer";

/** Selects a clause. */
export interface ClauseChoice {
  /** A document of the project. */
  readonly uri: string;
  /** IRI. */
  readonly clause: string;
}

export interface ToHistory {
  readonly type: "history";
  readonly choice: ClauseChoice;
  readonly history: ClauseHistory;
}

/** In addition to `{ type: "ready" }`. */
export type FromHistory =
  | { readonly type: "replay"; readonly run: number; readonly index: number }
  | { readonly type: "compare"; readonly before: number; readonly after: number };

/** State that the page keeps over reloads. */
export interface HistoryState {
  readonly choice: ClauseChoice;
}
