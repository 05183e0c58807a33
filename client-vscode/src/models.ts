// Determine the model of a command.
import * as vscode from "vscode";
import { withoutIcons } from "./literal";

const MODELS = "**/*.bdd";
const NOT_THERE = "**/{node_modules,.venv,.robbdd}/**";
/** Maximum number of models to choose from. */
const MOST = 200;

/** Languages of runnable files: models and executions. */
export const RUNNABLE = ["robbdd", "robbdd-bddx"];
/** Languages of studies. */
export const STUDIES = ["robbdd-study"];
/** Languages of files whose executions can be shown over their variables. */
export const STUDIED = ["robbdd", ...STUDIES];
/** Languages of files with executable scenes. */
export const SCENES = ["robbdd-scenex"];

/**
 * The model named by a menu, else the one in the active editor, else one in another visible editor, else the
 * workspace's only one or the one that the user chooses, which is opened. Shows a message and returns undefined if
 * there is none. Only editors of one of these languages are considered.
 */
export async function modelFor(target: unknown, languages = ["robbdd"]): Promise<vscode.Uri | undefined> {
  const isModel = (editor: vscode.TextEditor | undefined): boolean =>
    editor !== undefined && languages.includes(editor.document.languageId);
  const { activeTextEditor, visibleTextEditors } = vscode.window;
  const shown = isModel(activeTextEditor) ? activeTextEditor : visibleTextEditors.find(isModel);
  return target instanceof vscode.Uri ? target : (shown?.document.uri ?? (await openModel()));
}

/** Open a model of the workspace; if there are several, the user chooses. */
export async function openModel(): Promise<vscode.Uri | undefined> {
  const found = await vscode.workspace.findFiles(MODELS, NOT_THERE, MOST);
  const chosen = found.length > 1 ? await choose(found) : found[0];
  if (found.length === 0) {
    const begin = "New Project…";
    const message = "There is no .bdd file in this workspace: this command needs one with scenarios.";
    if ((await vscode.window.showInformationMessage(message, begin)) === begin) {
      void vscode.commands.executeCommand("robbdd.newProject");
    }
  } else if (chosen !== undefined) {
    await show(chosen);
  }
  return chosen;
}

/** Show a file, next to the walkthrough if that is visible. */
export async function show(uri: vscode.Uri): Promise<void> {
  const tab = vscode.window.tabGroups.activeTabGroup.activeTab;
  // Extensions cannot inspect the walkthrough's tab.
  const beside = tab !== undefined && tab.input === undefined;
  await vscode.window.showTextDocument(uri, { viewColumn: beside ? vscode.ViewColumn.Beside : vscode.ViewColumn.Active });
}

async function choose(models: readonly vscode.Uri[]): Promise<vscode.Uri | undefined> {
  const items = models
    .map((uri) => ({ label: withoutIcons(vscode.workspace.asRelativePath(uri)), uri }))
    .sort((one, other) => one.label.localeCompare(other.label));
  return (await vscode.window.showQuickPick(items, { title: "RobBDD", placeHolder: "Which model?" }))?.uri;
}
