// Messages with action buttons.
import * as vscode from "vscode";
import { withoutLinks } from "./literal";

export type Buttons = Readonly<Record<string, () => void>>;

export function complain(problem: string, buttons: Buttons = {}): void {
  follow(vscode.window.showErrorMessage(withoutLinks(problem), ...Object.keys(buttons)), buttons);
}

export function warn(problem: string, buttons: Buttons = {}): void {
  follow(vscode.window.showWarningMessage(withoutLinks(problem), ...Object.keys(buttons)), buttons);
}

export function inform(message: string, buttons: Buttons = {}): void {
  follow(vscode.window.showInformationMessage(withoutLinks(message), ...Object.keys(buttons)), buttons);
}

/** Execute the action of a clicked button. Not awaited: a restart would wait for itself. */
function follow(answer: Thenable<string | undefined>, buttons: Buttons): void {
  void answer.then((choice) => {
    if (choice !== undefined) {
      buttons[choice]?.();
    }
  });
}
