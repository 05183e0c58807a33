// Walkthrough progress: context keys that complete its steps, each set once in a window.
import * as vscode from "vscode";

const reached = new Set<string>();

export function reach(milestone: "projectBegun" | "modelShown" | "somethingHeld"): void {
  if (!reached.has(milestone)) {
    reached.add(milestone);
    void vscode.commands.executeCommand("setContext", `robbdd.${milestone}`, true);
  }
}

/** Complete a step when a model is shown. */
export function noticeModels(): vscode.Disposable {
  const notice = (editor: vscode.TextEditor | undefined): void => {
    if (editor?.document.languageId === "robbdd") {
      reach("modelShown");
    }
  };
  notice(vscode.window.activeTextEditor);
  return vscode.window.onDidChangeActiveTextEditor(notice);
}
