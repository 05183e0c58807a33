// The terminal of the editor finds the command line of the server in use.
import { basename, delimiter, dirname, join } from "node:path";
import type * as vscode from "vscode";

/** The program robbdd in the folder of a server. */
export function commandBeside(server: string): string {
  return join(dirname(server), basename(server).endsWith(".exe") ? "robbdd.exe" : "robbdd");
}

/** Append the folder of a server to PATH in new terminals; a `robbdd` that is on PATH takes precedence. */
export function offerCommandLine(variables: vscode.EnvironmentVariableCollection, server: string | undefined): void {
  if (server === undefined) {
    variables.delete("PATH");
  } else {
    variables.description = "Adds the command robbdd.";
    variables.append("PATH", `${delimiter}${dirname(server)}`);
  }
}
