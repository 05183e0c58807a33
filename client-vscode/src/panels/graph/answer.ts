// The server's answer to `robbdd/graph`.
import { type Location, isLocation } from "../../places";
import { isRecord } from "../../values";

/** The text of a node: its declaration, or a reference to it. */
export interface NodePlace extends Location {
  readonly iri: string;
}

export interface GraphNode {
  readonly iri: string;
  readonly concept: string;
  readonly name: string;
  readonly source: Location | null;
}

export interface GraphPicture {
  readonly uri: string;
  /** The picture; empty if nothing could be drawn. */
  readonly svg: string;
  /** Why the picture is older than the model; null if it is not. */
  readonly problem: string | null;
  readonly nodes: readonly GraphNode[];
  readonly places: readonly NodePlace[];
  readonly shown: number;
  readonly total: number;
  /** The node around which others are shown, if not all are shown. */
  readonly root: GraphNode | null;
}

/** Whether an answer has the form of this version. */
export function isGraphPicture(value: unknown): value is GraphPicture {
  return (
    isRecord(value) &&
    typeof value["uri"] === "string" &&
    typeof value["svg"] === "string" &&
    (value["problem"] === null || typeof value["problem"] === "string") &&
    typeof value["shown"] === "number" &&
    typeof value["total"] === "number" &&
    (value["root"] === null || isNode(value["root"])) &&
    Array.isArray(value["nodes"]) &&
    value["nodes"].every(isNode) &&
    Array.isArray(value["places"]) &&
    value["places"].every((place) => isRecord(place) && typeof place["iri"] === "string" && isLocation(place))
  );
}

/** Remark on a picture that does not show the whole current model; empty if it does. */
export function remark({ svg, problem, shown, total, root }: GraphPicture): string {
  if (problem !== null) {
    const made = svg === "" ? "There is nothing to draw yet" : "This is the last picture without errors";
    return `Out of date: the model has an error (${problem}). ${made}.`;
  }
  if (total === 0) {
    return "The model has no story, template or event yet.";
  }
  const around = root === null ? "" : ` around ${root.name}; move the cursor to see another part`;
  return shown < total ? `${shown} of ${total} nodes${around}.` : "";
}

function isNode(value: unknown): value is GraphNode {
  return (
    isRecord(value) &&
    typeof value["iri"] === "string" &&
    typeof value["concept"] === "string" &&
    typeof value["name"] === "string" &&
    (value["source"] === null || isLocation(value["source"]))
  );
}
