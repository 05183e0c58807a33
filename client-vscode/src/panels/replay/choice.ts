// Let the user choose a recorded execution, and read the server's list.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { withoutIcons } from "../../literal";
import { inform } from "../../notices";
import { type StoredRun, type StoredScenario, isRuns, outcome } from "../runs";
import type { Recording } from "./messages";

const SIGNS = { holds: "$(pass)", violated: "$(error)", unknown: "$(question)" } as const;

/**
 * Let the user choose a stored run of a project, then one of its scenarios; undefined without any or without a choice.
 */
export async function chooseRecording(server: Server, uri: string): Promise<Recording | undefined> {
  const run = await chooseRun(server, uri, "Replay: which run?");
  const answer = run === undefined ? undefined : await server.request("robbdd/runs", { uri, run: run.run });
  const scenarios = isRuns(answer) ? (answer.runs[0]?.scenarios ?? []) : [];
  const items = scenarios.filter(({ trace }) => trace).map((scenario) => ({ ...described(scenario), scenario }));
  if (run === undefined || items.length === 0) {
    if (run !== undefined) {
      inform(`Run ${run.run} keeps no recorded execution.`);
    }
    return undefined;
  }
  const title = `Replay: which scenario of run ${run.run}?`;
  const chosen = items.length === 1 ? items[0] : await vscode.window.showQuickPick(items, { title, matchOnDetail: true });
  return chosen && { uri, run: run.run, index: chosen.scenario.index };
}

/** Let the user choose a stored run of a project; newest first, without asking if there is only one. */
export async function chooseRun(server: Server, uri: string, title: string): Promise<StoredRun | undefined> {
  const answer = await server.request("robbdd/runs", { uri });
  const runs = isRuns(answer) ? answer.runs.filter(({ problem }) => problem === null).reverse() : [];
  if (runs.length === 0) {
    inform("There is no stored run yet: run a scenario first.");
    return undefined;
  }
  const items = runs.map((run) => ({ label: `Run ${run.run}`, description: withoutIcons(`${run.path}: ${outcome(run)}`), run }));
  return items.length === 1 ? runs[0] : (await vscode.window.showQuickPick(items, { title }))?.run;
}

function described({ name, values, verdict, repetition }: StoredScenario): vscode.QuickPickItem {
  const again = repetition > 1 ? `, repetition ${repetition}` : "";
  const shown = withoutIcons(name.replace(/^[^:]*:/, ""));
  return { label: `${SIGNS[verdict]} ${shown}${again}`, detail: withoutIcons(values) };
}
