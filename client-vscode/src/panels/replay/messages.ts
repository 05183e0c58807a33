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
  /** Of an execution of a study, whose file is `uri`: its number in the study. */
  readonly number?: number;
}

export type ToReplay =
  | {
      readonly type: "trace";
      readonly recording: Recording;
      readonly trace: Trace;
      /** The clause to select, by its IRI or by its number. */
      readonly clause?: string | number;
      readonly time?: number;
    }
  | { readonly type: "clause"; readonly clause: string }
  /** Show a time, s. */
  | { readonly type: "time"; readonly time: number }
  /** Something to say to the user. */
  | { readonly type: "said"; readonly words: string }
  /** Changes since the recording. */
  | { readonly type: "age"; readonly text: string };

/** In addition to `{ type: "ready" }`, which every page sends when it listens. */
export type FromReplay =
  /** The number of a clause whose text is requested. */
  | { readonly type: "open"; readonly clause: number }
  /** Copy a link to a time (s), with the selected clause. */
  | { readonly type: "link"; readonly time: number; readonly clause: number }
  /** Save a picture, PNG in base64: the page was not allowed to copy it. */
  | { readonly type: "picture"; readonly data: string };

/** State that a replay page keeps over reloads. */
export interface ReplayState {
  readonly recording: Recording;
  /** s */
  readonly time: number;
  readonly clause: number;
  /** The followed body by its words; undefined for none. */
  readonly follow?: string;
  readonly named?: boolean;
  readonly framed?: boolean;
  readonly pressed?: boolean;
  /** Position of the camera and its target; undefined without a picture. */
  readonly camera?: readonly number[];
}
