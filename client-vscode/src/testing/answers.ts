// Answers of the server's commands that run scenarios.
import type * as answers from "../answers/runanswer";
import { isRunAnswer } from "../answers/validators.mjs";
import type { Immutable } from "../immutable";

export type Outcome = Immutable<answers.Outcome>;

/** The outcome of a run; undefined if nothing was run. */
export function outcomeOf(answer: unknown): Outcome | undefined {
  return isRunAnswer(answer) && "stored" in answer ? answer : undefined;
}

/** Why nothing was run, if so. */
export function problemOf(answer: unknown): string | undefined {
  return isRunAnswer(answer) && "problem" in answer ? answer.problem : undefined;
}

/** Whether the refusal is unrelated to the scenarios: another run is in progress, or nothing had failed. */
export function isMomentary(answer: unknown): boolean {
  return isRunAnswer(answer) && "momentary" in answer;
}

/** Addresses of the pictures of a run. */
export function picturesOf(answer: unknown): readonly string[] {
  return outcomeOf(answer)?.pictures ?? [];
}

/** Address of the folder with a run's recording. */
export function recordedIn(answer: unknown): string | undefined {
  return outcomeOf(answer)?.stored.folder;
}
