// The server's answer to `robbdd/preview`, and the map from a place in a model to a line of its feature.
import type * as answers from "../answers/preview";
import type { Immutable } from "../immutable";
import { type Place, innermost } from "../places";

export { isPreview } from "../answers/validators.mjs";

export type Preview = Immutable<answers.Preview>;
/** A line of the feature, from 0, and its source text. */
export type PreviewLine = Preview["lines"][number];

/**
 * The feature line of the innermost text at the cursor. It may be repeated in each scenario; then the line nearest to
 * the one currently shown.
 */
export function lineAt(lines: readonly PreviewLine[], uri: string, cursor: Place, present: number): number | undefined {
  const away = ({ line }: PreviewLine) => Math.abs(line - present);
  return innermost(lines, uri, cursor, (one, other) => (away(other) < away(one) ? other : one))?.line;
}
