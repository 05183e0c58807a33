// Messages between the extension and the study page.
import type { PackedResults } from "./packed";

/** Selects a stored run, or the executions of a `.study`. */
export interface StudiedRun {
  /** A document of the project; without a run, the file of the study. */
  readonly uri: string;
  readonly run?: number;
}

export interface ToStudy {
  readonly type: "results";
  readonly studied: StudiedRun;
  readonly title: string;
  readonly results: PackedResults;
  /** What to show; undefined for what the page showed last. */
  readonly show?: StudyPart;
}

/** A heat map over two variables with the margins, or the matrix of all verdicts. */
export type StudyPart = "factors" | "matrix";

/** In addition to `{ type: "ready" }`: the number of the scenario to replay, and the clause to select. */
export interface FromStudy {
  readonly type: "replay";
  readonly index: number;
  readonly clause?: string;
}

/** State that a study page keeps over reloads: the run, and the selection. */
export interface StudyState {
  readonly studied: StudiedRun;
  readonly across: string;
  readonly down: string;
  readonly clause: string;
  readonly part: StudyPart;
}
