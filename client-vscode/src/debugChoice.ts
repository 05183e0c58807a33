// Begin to debug one execution of a scenario, with breakpoints on its clauses; the user chooses if there are several.
import * as vscode from "vscode";
import type { DebugTarget } from "./answers/debugtarget";
import { isDebugTarget } from "./answers/validators.mjs";
import type { Server } from "./client";
import { TYPE } from "./debugging";
import { withoutIcons } from "./literal";
import { type ListedTest, isListing } from "./testing/listing";

/** Number of executions among which one can be chosen by its values. */
const MOST_LISTED = 1000;

/** Debug the scenario that the argument of a lens names, or the first one of a model. */
export async function debugScenario(server: Server, uri: string, target: unknown): Promise<void> {
  const model = vscode.Uri.parse(uri);
  const chosen = isDebugTarget(target) ? await choose(server, uri, target) : {};
  if (chosen !== undefined) {
    const configuration = { type: TYPE, request: "launch", name: "RobBDD", program: model.fsPath, ...chosen };
    await vscode.debug.startDebugging(vscode.workspace.getWorkspaceFolder(model), configuration);
  }
}

/** The arguments that select one execution; undefined without a choice. */
async function choose(
  server: Server,
  uri: string,
  { scenario, variant, count }: Readonly<DebugTarget>,
): Promise<{ readonly scenario: string; readonly variation?: number } | undefined> {
  if (count === 1) {
    return { scenario };
  }
  const answer = await server.ask("robbdd/tests", { uri, variant, most: MOST_LISTED });
  if (!isListing(answer)) {
    return undefined;
  }
  const { tests } = answer;
  if (tests.length < 2) {
    return { scenario };
  }
  const cut = count !== null && count > tests.length ? ` of the first ${tests.length} of ${count.toLocaleString("en")}` : "";
  const title = `Debug: which scenario${cut}?`;
  const picked = await vscode.window.showQuickPick(tests.map(listed), { title });
  return picked && { scenario, ...(picked.variation === undefined ? {} : { variation: picked.variation }) };
}

function listed({ name, detail, number }: ListedTest): vscode.QuickPickItem & { readonly variation: number | undefined } {
  return { label: withoutIcons(name), description: withoutIcons(detail), variation: number };
}
