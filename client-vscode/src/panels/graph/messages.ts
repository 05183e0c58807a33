// What the extension and the page of the graph say to each other.

export type ToGraph =
  | {
      readonly type: "picture";
      readonly uri: string;
      readonly svg: string;
      readonly remark: string;
      /** The remark is about an error. */
      readonly outdated: boolean;
      /** What the picture is about: another subject is shown from its beginning. */
      readonly subject: string;
    }
  /** Mark a node, and bring it into view if `move` says so. */
  | { readonly type: "highlight"; readonly iri: string | null; readonly move: boolean };

/** Beside `{ type: "ready" }`, which every page says when it can listen. */
export interface FromGraph {
  readonly type: "open";
  readonly iri: string;
}

/** What the page of a graph leaves behind for its next life. */
export interface GraphState {
  readonly uri: string;
  readonly subject: string;
  readonly view: { readonly x: number; readonly y: number; readonly scale: number };
}
