// Margins as they are drawn: above zero where a clause holds.
import type { Part } from "../../src/panels/replay/answer";

/** The points of a part in the clause's sense: positive where the clause gets what it wants. */
export function points({ times, margins, negated }: Part): [number, number][] {
  return times.map((time, index) => {
    const margin = margins[index] ?? 0;
    return [time, negated ? -margin : margin];
  });
}

/** The least and the largest of some margins and zero, with room around them. */
export function extent(values: readonly number[]): [number, number] {
  const low = Math.min(0, ...values);
  const high = Math.max(0, ...values);
  const room = (high - low || 1) * 0.08;
  return [low - room, high + room];
}
