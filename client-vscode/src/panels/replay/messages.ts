// What the extension and the page of a replay say to each other.
import type { Trace } from "./answer";

/** Which recorded execution is meant; what is left out, the server chooses. */
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
  | { readonly type: "trace"; readonly recording: Recording; readonly trace: Trace; readonly clause?: string }
  | { readonly type: "clause"; readonly clause: string }
  /** What has changed since it was recorded. */
  | { readonly type: "age"; readonly text: string };

/** Beside `{ type: "ready" }`, which every page says when it can listen: the number of a clause whose text is wanted. */
export interface FromReplay {
  readonly type: "open";
  readonly clause: number;
}

/** What the page of a replay leaves behind for its next life. */
export interface ReplayState {
  readonly recording: Recording;
  /** s */
  readonly time: number;
  readonly clause: number;
  /** Position of the camera and what it looks at; none where there is no picture. */
  readonly camera?: readonly number[];
}
