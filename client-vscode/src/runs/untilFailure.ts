// Run until it fails: execute scenarios again and again, with different seeds, up to the first failure.
import * as vscode from "vscode";
import { inform } from "../notices";
import { outcomeOf } from "../testing/answers";
import { numberProblem, typedNumber } from "./options";

/** Executions of each scenario, unless the user gives another number. */
const USUAL = 100;

/** An execution in a stored run. */
export interface Failed {
  readonly run: number;
  readonly index: number;
}

/** Ask how often to try; return the arguments of `robbdd.run`, or undefined if the user cancels. */
export async function askUntilFailure(): Promise<Readonly<Record<string, unknown>> | undefined> {
  const typed = await vscode.window.showInputBox({
    title: "Run until It Fails",
    prompt: `How often should each scenario be executed at most? Each execution has a seed of its own. Default: ${USUAL}.`,
    value: String(USUAL),
    validateInput: (text) => numberProblem(text),
  });
  return typed === undefined ? undefined : { repeat: typedNumber(typed) ?? USUAL, stop_on_failure: true };
}

/** The first execution of a run that did not hold, from the server's answer; undefined if all held. */
export function failedIn(answer: unknown): Failed | undefined {
  const outcome = outcomeOf(answer);
  if (outcome === undefined || outcome.failed === null) {
    return undefined;
  }
  return { run: outcome.stored.run, index: outcome.failed };
}

/** Show how it ended, with the replay of the failure. */
export function tellFailure(answer: unknown, replay: (failed: Failed) => void): void {
  const failed = failedIn(answer);
  if (failed !== undefined) {
    const place = `Execution ${failed.index + 1} of run ${failed.run} did not hold`;
    inform(`${place}, ${failed.index === 0 ? "the first one" : `after ${failed.index} that did`}.`, {
      Replay: () => {
        replay(failed);
      },
    });
    return;
  }
  const outcome = outcomeOf(answer);
  if (outcome?.cancelled === false) {
    inform(`All ${outcome.holds} executions held.`);
  }
}
