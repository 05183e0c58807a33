// The server's answer to `robbdd/preview`, and the map from a place in a model to a line of its feature.
import { type Location, type Place, innermost, isLocation } from "../places";
import { isRecord } from "../values";

/** A line of the feature, from 0, and its source text. */
export interface PreviewLine extends Location {
  readonly line: number;
}

export interface Preview {
  readonly text: string;
  /** Why the text is older than the model; null if it is not. */
  readonly problem: string | null;
  readonly lines: readonly PreviewLine[];
}

/**
 * The feature line of the innermost text at the cursor. It may be repeated in each scenario; then the line nearest to
 * the one currently shown.
 */
export function lineAt(lines: readonly PreviewLine[], uri: string, cursor: Place, present: number): number | undefined {
  const away = ({ line }: PreviewLine) => Math.abs(line - present);
  return innermost(lines, uri, cursor, (one, other) => (away(other) < away(one) ? other : one))?.line;
}

/** Whether an answer has the form of this version. */
export function isPreview(value: unknown): value is Preview {
  return (
    isRecord(value) &&
    typeof value["text"] === "string" &&
    (value["problem"] === null || typeof value["problem"] === "string") &&
    Array.isArray(value["lines"]) &&
    value["lines"].every((line) => isRecord(line) && typeof line["line"] === "number" && isLocation(line))
  );
}
