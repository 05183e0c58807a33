// Places in texts as sent by the server, and those at a cursor.
import { isRecord } from "./values";

export interface Place {
  readonly line: number;
  readonly character: number;
}

export interface Range {
  readonly start: Place;
  readonly end: Place;
}

export interface Location {
  readonly uri: string;
  readonly range: Range;
}

/**
 * The innermost of the entries whose text is around the cursor; among several with the same text, the `best` of two.
 */
export function innermost<Entry extends Location>(
  entries: Iterable<Entry>,
  uri: string,
  cursor: Place,
  best: (one: Entry, other: Entry) => Entry = (one) => one,
): Entry | undefined {
  let found: Entry | undefined;
  for (const entry of entries) {
    if (entry.uri === uri && holds(entry.range, cursor)) {
      if (found === undefined || same(entry.range, found.range)) {
        found = found === undefined ? entry : best(found, entry);
      } else if (holds(found.range, entry.range.start) && holds(found.range, entry.range.end)) {
        found = entry;
      }
    }
  }
  return found;
}

export function isLocation(value: unknown): value is Location {
  return isRecord(value) && typeof value["uri"] === "string" && isRange(value["range"]);
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

function isRange(value: unknown): boolean {
  return isRecord(value) && isPlace(value["start"]) && isPlace(value["end"]);
}

function isPlace(value: unknown): boolean {
  return isRecord(value) && typeof value["line"] === "number" && typeof value["character"] === "number";
}
