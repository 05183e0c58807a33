// The server's answer to `robbdd/runs`: stored runs, the oldest first; docs/schemas/runs.schema.json.
import type * as answers from "../answers/runs";
import type { Immutable } from "../immutable";

export { isStoredRuns as isRuns } from "../answers/validators.mjs";

export type StoredRun = Immutable<answers.Run>;
export type StoredScenario = Immutable<answers.Scenario>;

/** The verdicts of a run's scenarios, and the progress of an unfinished run. */
export function outcome({ holds, violated, unknown, state, finished, total }: StoredRun): string {
  const parts = [`${holds} hold`, `${violated} violated`, `${unknown} unknown`].filter((part) => !part.startsWith("0 "));
  const counts = parts.join(", ") || "nothing judged";
  const extent = `${finished} of ${total} finished`;
  return state === "finished" ? counts : `${counts} (${state === "stopped" ? "stopped at the first failure" : state}: ${extent})`;
}
