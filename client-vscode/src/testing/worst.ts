// Combine several verdicts on one item: a repeated execution judges its clauses repeatedly.
import type { Outcome } from "./outcomes";

interface Seen {
  held: number;
  count: number;
  worst: Outcome;
  margin: number;
}

const BADNESS = { failed: 0, errored: 1, skipped: 2, passed: 3 } as const;

/** A clause gets its worst verdict in a run, and the number of times it held. */
export class Worst<I> {
  private readonly seen = new Map<I, Seen>();

  has(item: I): boolean {
    return this.seen.has(item);
  }

  /** Add a verdict, with its margin if known, and return the combined outcome of the item. */
  add(item: I, outcome: Outcome, margin: number | null = null): Outcome {
    const held = outcome.state === "passed" ? 1 : 0;
    const here = margin ?? Infinity;
    const known = this.seen.get(item);
    if (known === undefined) {
      this.seen.set(item, { held, count: 1, worst: outcome, margin: here });
      return outcome;
    }
    known.held += held;
    known.count += 1;
    const difference = BADNESS[outcome.state] - BADNESS[known.worst.state];
    if (difference < 0 || (difference === 0 && here < known.margin)) {
      known.worst = outcome;
      known.margin = here;
    }
    return outcomeOf(known);
  }
}

function outcomeOf({ held, count, worst }: Seen): Outcome {
  const note = [`${held}/${count} hold`, worst.note].filter((part) => part !== "").join(" · ");
  const { failure } = worst;
  return failure === undefined
    ? { ...worst, note }
    : { ...worst, note, failure: { ...failure, text: `${failure.text} · ${held} of ${count} hold` } };
}
