// Messages between the extension and the replay page.
import type { Trace } from "./answer";

/** Selects a recorded execution; the server chooses for missing fields. */
export interface Recording {
  /** A document of the project. */
  readonly uri: string;
  readonly run?: number | string;
  readonly index?: number;
  readonly variant?: string;
  readonly variation?: number;
  /** IRI of the execution that it was run by. */
  readonly execution?: string;
  readonly repetition?: number;
}

export type ToReplay =
  | { readonly type: "trace"; readonly recording: Recording; readonly trace: Trace; readonly clause?: string; /** To show, s. */ readonly time?: number }
  | { readonly type: "clause"; readonly clause: string }
  /** Changes since the recording. */
  | { readonly type: "age"; readonly text: string };

/**
 * In addition to `{ type: "ready" }`, which every page sends when it listens: the number of a clause whose text is
 * requested.
 */
export interface FromReplay {
  readonly type: "open";
  readonly clause: number;
}

/** State that a replay page keeps over reloads. */
export interface ReplayState {
  readonly recording: Recording;
  /** s */
  readonly time: number;
  readonly clause: number;
  /** Position of the camera and its target; undefined without a picture. */
  readonly camera?: readonly number[];
}
