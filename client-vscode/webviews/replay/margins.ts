// Margins for drawing: above zero if a clause holds.
import type { Part } from "../../src/panels/replay/answer";

/** The points of a part, with the sign such that positive means that the clause holds. */
export function points({ times, margins, negated }: Part): [number, number][] {
  return times.map((time, index) => {
    const margin = margins[index] ?? 0;
    return [time, negated ? -margin : margin];
  });
}

/** The minimum and maximum of some margins and zero, with padding. */
export function extent(values: readonly number[]): [number, number] {
  const low = Math.min(0, ...values);
  const high = Math.max(0, ...values);
  const room = (high - low || 1) * 0.08;
  return [low - room, high + room];
}
