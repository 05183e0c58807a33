// What a verdict on a clause is in the words of the editor's tests.
import { marginOf, seconds } from "../runs/report";

/** What is expected of a margin. */
export const NO_LESS = "margin ≥ 0";

/** A verdict, from a run's message or from a stored result. */
export interface Judged {
  readonly verdict: "holds" | "violated" | "unknown";
  readonly robustness: number | null;
  readonly unit: string;
  readonly at: number | null;
  readonly reason: string;
  readonly vacuous?: string;
}

export interface Failure {
  /** What is shown beside the clause. */
  readonly text: string;
  /** What the comparison shows; an unknown verdict has none. */
  readonly expected?: string;
  readonly actual?: string;
}

export interface Outcome {
  readonly state: "passed" | "failed" | "errored";
  /** What follows the clause's name in the tree. */
  readonly note: string;
  readonly failure?: Failure;
}

/**
 * A violated clause has failed; an unknown one, which says nothing about the robot, has an error.
 *
 * `values` tell the scenario from others that are shown at the same clause.
 */
export function outcomeOf(judged: Judged, values: string): Outcome {
  const margin = marginOf(judged);
  const where = values === "" ? "" : ` [${values}]`;
  const because = judged.reason === "" ? "" : `: ${judged.reason}`;
  switch (judged.verdict) {
    case "holds": {
      const vacuous = judged.vacuous ?? "";
      return { state: "passed", note: joined(margin, vacuous === "" ? "" : `vacuous: ${vacuous}`) };
    }
    case "violated": {
      const instant = judged.at === null ? "" : ` at ${seconds(judged.at)}`;
      const words = `violated${margin === "" ? "" : ` by ${margin}`}${instant}`;
      // Short, so that the editor shows both whole in one line beside the clause.
      const expected = margin === "" ? "holds" : NO_LESS;
      const actual = margin === "" ? `violated${instant}` : `${margin}${instant}`;
      return {
        state: "failed",
        note: joined(margin, instant.trim()),
        failure: { text: `${words}${because}${where}`, expected, actual },
      };
    }
    case "unknown":
      return { state: "errored", note: "unknown", failure: { text: `unknown${because}${where}` } };
  }
}

function joined(...parts: string[]): string {
  return parts.filter((part) => part !== "").join(" · ");
}
