// Messages between the extension and the graph page.

export type ToGraph =
  | {
      readonly type: "picture";
      readonly uri: string;
      readonly svg: string;
      readonly remark: string;
      /** The remark is about an error. */
      readonly outdated: boolean;
      /** The subject of the picture: a new subject resets the view. */
      readonly subject: string;
    }
  /** Highlight a node, and scroll it into view if `move` is set. */
  | { readonly type: "highlight"; readonly iri: string | null; readonly move: boolean };

/** In addition to `{ type: "ready" }`, which every page sends when it listens. */
export interface FromGraph {
  readonly type: "open";
  readonly iri: string;
}

/** State that a graph page keeps over reloads. */
export interface GraphState {
  readonly uri: string;
  readonly subject: string;
  readonly view: { readonly x: number; readonly y: number; readonly scale: number };
}
