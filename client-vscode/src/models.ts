// Which model a command is about.
import * as vscode from "vscode";

const MODELS = "**/*.bdd";
const NOT_THERE = "**/{node_modules,.venv,.robbdd}/**";
/** More than anybody wants to choose from. */
const MOST = 200;

/** What says by itself which scenarios are executed: a model, and the executions of one. */
export const RUNNABLE = ["robbdd", "robbdd-bddx"];

/**
 * The model that a menu names, else the one in the active editor, else one in another visible editor, else the
 * workspace's only one or the one that the user chooses, which is opened. Undefined, after a message, if there is none.
 * Editors count that show one of these languages.
 */
export async function modelFor(target: unknown, languages = ["robbdd"]): Promise<vscode.Uri | undefined> {
  const isModel = (editor: vscode.TextEditor | undefined): boolean =>
    editor !== undefined && languages.includes(editor.document.languageId);
  const { activeTextEditor, visibleTextEditors } = vscode.window;
  const shown = isModel(activeTextEditor) ? activeTextEditor : visibleTextEditors.find(isModel);
  return target instanceof vscode.Uri ? target : (shown?.document.uri ?? (await openModel()));
}

/** Open a model of the workspace; where there are several, the user chooses. */
export async function openModel(): Promise<vscode.Uri | undefined> {
  const found = await vscode.workspace.findFiles(MODELS, NOT_THERE, MOST);
  const chosen = found.length > 1 ? await choose(found) : found[0];
  if (found.length === 0) {
    const begin = "New Project…";
    const message = "There is no .bdd file in this workspace: its scenarios are what this command is about.";
    if ((await vscode.window.showInformationMessage(message, begin)) === begin) {
      void vscode.commands.executeCommand("robbdd.newProject");
    }
  } else if (chosen !== undefined) {
    await show(chosen);
  }
  return chosen;
}

/** Show a file; where the walkthrough is in front, beside it, so that both can be seen. */
export async function show(uri: vscode.Uri): Promise<void> {
  const tab = vscode.window.tabGroups.activeTabGroup.activeTab;
  // A tab of the walkthrough is one that extensions cannot see.
  const beside = tab !== undefined && tab.input === undefined;
  await vscode.window.showTextDocument(uri, { viewColumn: beside ? vscode.ViewColumn.Beside : vscode.ViewColumn.Active });
}

async function choose(models: readonly vscode.Uri[]): Promise<vscode.Uri | undefined> {
  const items = models
    .map((uri) => ({ label: vscode.workspace.asRelativePath(uri), uri }))
    .sort((one, other) => one.label.localeCompare(other.label));
  return (await vscode.window.showQuickPick(items, { title: "RobBDD", placeHolder: "Which model?" }))?.uri;
}
