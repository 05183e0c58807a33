// What the extension and the page of a study say to each other.
import type { Results } from "./results";

/** Which stored run is meant. */
export interface StudiedRun {
  /** A document of the project. */
  readonly uri: string;
  readonly run: number;
}

export interface ToStudy {
  readonly type: "results";
  readonly studied: StudiedRun;
  readonly title: string;
  readonly results: Results;
}

/** Beside `{ type: "ready" }`: the number of the scenario that is to be replayed, and the clause to look at. */
export interface FromStudy {
  readonly type: "replay";
  readonly index: number;
  readonly clause?: string;
}

/** What the page of a study leaves behind for its next life: the run, and what was chosen to be shown. */
export interface StudyState {
  readonly studied: StudiedRun;
  readonly across: string;
  readonly down: string;
  readonly clause: string;
}
