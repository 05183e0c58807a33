// Let the user choose a recorded execution, and read the server's list.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { withoutIcons } from "../../literal";
import { inform } from "../../notices";
import { type StoredRun, type StoredScenario, isRuns, outcome } from "../runs";
import type { RunPair } from "../comparison/messages";
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

/** Let the user choose two stored runs of a project to compare; the later one is compared with the other one. */
export async function chooseRuns(server: Server, uri: string): Promise<RunPair | undefined> {
  const runs = await readableRuns(server, uri);
  if (runs.length < 2) {
    inform("There are no two stored runs yet to compare: run the scenarios again.");
    return undefined;
  }
  const options = { title: "Compare: which two runs?", canPickMany: true as const };
  const items = runs.map((run, place) => ({ ...listed(run), picked: place < 2 }));
  const chosen = await vscode.window.showQuickPick(items, options);
  const [before, after, ...more] = (chosen ?? []).map(({ run }) => run.run).sort((one, other) => one - other);
  if (before === undefined || after === undefined || more.length > 0) {
    if (chosen !== undefined) {
      inform("Select exactly two runs to compare.");
    }
    return undefined;
  }
  return { uri, before, after };
}

/** Let the user choose a stored run of a project; newest first, without asking if there is only one. */
export async function chooseRun(server: Server, uri: string, title: string): Promise<StoredRun | undefined> {
  const runs = await readableRuns(server, uri);
  if (runs.length === 0) {
    inform("There is no stored run yet: run a scenario first.");
    return undefined;
  }
  const items = runs.map(listed);
  return items.length === 1 ? runs[0] : (await vscode.window.showQuickPick(items, { title }))?.run;
}

/** The readable runs of a project, newest first. */
async function readableRuns(server: Server, uri: string): Promise<StoredRun[]> {
  const answer = await server.request("robbdd/runs", { uri });
  return isRuns(answer) ? answer.runs.filter(({ problem }) => problem === null).reverse() : [];
}

function listed(run: StoredRun): vscode.QuickPickItem & { readonly run: StoredRun } {
  return { label: `Run ${run.run}`, description: withoutIcons(`${run.path}: ${outcome(run)}`), run };
}

function described({ name, values, verdict, repetition }: StoredScenario): vscode.QuickPickItem {
  const again = repetition > 1 ? `, repetition ${repetition}` : "";
  const shown = withoutIcons(name.replace(/^[^:]*:/, ""));
  return { label: `${SIGNS[verdict]} ${shown}${again}`, detail: withoutIcons(values) };
}
