// Leads to the settings of the language server.
import * as vscode from "vscode";

/** Open it where it can be set: a path of the machine that a remote window works on is not among the user's own. */
export function openServerSetting(name: "path" | "package" = "path"): void {
  const page =
    vscode.env.remoteName === undefined ? "workbench.action.openSettings" : "workbench.action.openRemoteSettings";
  void vscode.commands.executeCommand(page, { query: `@id:robbdd.server.${name}` });
}
