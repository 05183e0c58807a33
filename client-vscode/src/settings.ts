// Open the settings of the language server.
import * as vscode from "vscode";

/** Open a setting where it can be changed: in a remote window, paths of the machine are not user settings. */
export function openServerSetting(name: "path" | "package" = "path"): void {
  const page =
    vscode.env.remoteName === undefined ? "workbench.action.openSettings" : "workbench.action.openRemoteSettings";
  void vscode.commands.executeCommand(page, { query: `@id:robbdd.server.${name}` });
}
