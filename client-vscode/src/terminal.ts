// The terminal of the editor finds the command line of the server in use.
import { delimiter, dirname } from "node:path";
import type * as vscode from "vscode";

/** Append the folder of a server to PATH in new terminals; a `robbdd` that is on PATH takes precedence. */
export function offerCommandLine(variables: vscode.EnvironmentVariableCollection, server: string | undefined): void {
  if (server === undefined) {
    variables.delete("PATH");
  } else {
    variables.description = "Adds the command robbdd.";
    variables.append("PATH", `${delimiter}${dirname(server)}`);
  }
}
