// The server's answer to `robbdd/preview`, and the way from a place in a model to a line of its feature.
import { isRecord } from "../values";

export interface Place {
  readonly line: number;
  readonly character: number;
}

export interface Range {
  readonly start: Place;
  readonly end: Place;
}

/** A line of the feature, from 0, and the text that it was made from. */
export interface PreviewLine {
  readonly line: number;
  readonly uri: string;
  readonly range: Range;
}

export interface Preview {
  readonly text: string;
  /** Why the text is older than the model; null when it is not. */
  readonly problem: string | null;
  readonly lines: readonly PreviewLine[];
}

/**
 * The line that shows what the cursor is in: of the innermost text around it, which may be repeated in each scenario,
 * the line nearest to the one shown at present.
 */
export function lineAt(lines: readonly PreviewLine[], uri: string, cursor: Place, present: number): number | undefined {
  let best: PreviewLine | undefined;
  for (const entry of lines) {
    if (entry.uri === uri && holds(entry.range, cursor) && (best === undefined || closer(entry, best, present))) {
      best = entry;
    }
  }
  return best?.line;
}

/** Whether an answer has the form of this version. */
export function isPreview(value: unknown): value is Preview {
  return (
    isRecord(value) &&
    typeof value["text"] === "string" &&
    (value["problem"] === null || typeof value["problem"] === "string") &&
    Array.isArray(value["lines"]) &&
    value["lines"].every(isLine)
  );
}

function closer(one: PreviewLine, other: PreviewLine, present: number): boolean {
  if (!same(one.range, other.range)) {
    return holds(other.range, one.range.start) && holds(other.range, one.range.end);
  }
  return Math.abs(one.line - present) < Math.abs(other.line - present);
}

function holds({ start, end }: Range, place: Place): boolean {
  return !before(place, start) && !before(end, place);
}

function before(one: Place, other: Place): boolean {
  return one.line < other.line || (one.line === other.line && one.character < other.character);
}

function same(one: Range, other: Range): boolean {
  return samePlace(one.start, other.start) && samePlace(one.end, other.end);
}

function samePlace(one: Place, other: Place): boolean {
  return one.line === other.line && one.character === other.character;
}

function isLine(value: unknown): boolean {
  return isRecord(value) && typeof value["line"] === "number" && typeof value["uri"] === "string" && isRange(value["range"]);
}

function isRange(value: unknown): boolean {
  return isRecord(value) && isPlace(value["start"]) && isPlace(value["end"]);
}

function isPlace(value: unknown): boolean {
  return isRecord(value) && typeof value["line"] === "number" && typeof value["character"] === "number";
}
