// Convert a clause's verdict to the editor's test states.
import { marginOf, seconds } from "../runs/report";

/** The expected margin. */
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
  /** Text shown next to the clause. */
  readonly text: string;
  /** The expected value of the comparison; an unknown verdict has none. */
  readonly expected?: string;
  readonly actual?: string;
}

export interface Outcome {
  readonly state: "passed" | "failed" | "errored";
  /** Note after the clause's name in the tree. */
  readonly note: string;
  readonly failure?: Failure;
}

/**
 * A violated clause has failed; an unknown one, which proves nothing about the robot, has an error. `values`
 * distinguish the scenario from others shown at the same clause.
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
      // Short, so that the editor shows both on one line next to the clause.
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
