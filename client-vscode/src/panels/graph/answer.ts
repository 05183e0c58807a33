// The server's answer to `robbdd/graph`.
import type * as answers from "../../answers/graph";
import type { Immutable } from "../../immutable";

export { isGraphPicture } from "../../answers/validators.mjs";

export type GraphPicture = Immutable<answers.GraphPicture>;
export type GraphNode = Immutable<answers.Node>;
/** The text of a node: its declaration, or a reference to it. */
export type NodePlace = Immutable<answers.Place>;

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
