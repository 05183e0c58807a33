// Messages between the extension and the study page.
import type { Results } from "./results";

/** Selects a stored run. */
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
}
