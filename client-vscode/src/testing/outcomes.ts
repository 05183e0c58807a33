// Convert a clause's verdict to the editor's test states.
import type { Immutable } from "../immutable";
import type { Because as FoundBecause } from "../answers/testresults";
import type { Because } from "../runs/messages";
import { marginOf, seconds } from "../runs/report";

/** A verdict, from a run's message or from a stored result. */
export interface Judged {
  readonly verdict: "holds" | "violated" | "unknown";
  readonly robustness: number | null;
  readonly unit: string;
  readonly at: number | null;
  readonly reason: string;
  /** Why it is violated or unknown, the reason first. */
  readonly failure: string;
  readonly vacuous?: string;
}

export interface Failure {
  /** Text shown next to the clause, the reason first. */
  readonly text: string;
}

export interface Outcome {
  /** `skipped` is the state of a clause that is unknown only because of another one, which has the reason. */
  readonly state: "passed" | "failed" | "errored" | "skipped";
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
  switch (judged.verdict) {
    case "holds": {
      const vacuous = judged.vacuous ?? "";
      return { state: "passed", note: joined(margin, vacuous === "" ? "" : `vacuous: ${vacuous}`) };
    }
    case "violated": {
      const instant = judged.at === null ? "" : `at ${seconds(judged.at)}`;
      return { state: "failed", note: joined(judged.reason, margin, instant), failure: failureOf(judged, values) };
    }
    case "unknown":
      return { state: "errored", note: judged.reason || "unknown", failure: failureOf(judged, values) };
  }
}

/**
 * The outcome of a clause that is unknown because of another one; if there is no such cause, `outcome` itself.
 *
 * An item of the tree has the worst state of those below it, and the editor takes *errored* for worse than *failed*: with
 * errors in the consequences of a violated clause, a failed scenario would be shown as errored. `shown` says that the
 * cause has a failure or an error in the same scenario; without it, a scenario with a skipped clause would have passed.
 */
export function folded(outcome: Outcome, because: Because | Immutable<FoundBecause> | null | undefined, shown: boolean): Outcome {
  return because && shown ? { state: "skipped", note: because.words } : outcome;
}

/**
 * The outcome of a clause in a scenario that has failed: an unknown clause is skipped, with its reason as note, since the
 * editor would otherwise show the scenario as errored, and everything else says that it has failed.
 */
export function inFailed(outcome: Outcome): Outcome {
  return outcome.state === "errored" ? { state: "skipped", note: outcome.note } : outcome;
}

/** `values` distinguish the scenario from others shown at the same clause. */
export function failureOf({ failure }: Pick<Judged, "failure">, values: string): Failure {
  return { text: values === "" ? failure : `${failure} [${values}]` };
}

function joined(...parts: string[]): string {
  return parts.filter((part) => part !== "").join(" · ");
}
