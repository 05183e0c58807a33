// Read the inputs of the server lookup from the editor and the machine.
import { accessSync, constants, statSync } from "node:fs";
import { homedir } from "node:os";
import * as vscode from "vscode";
import type { Surroundings } from "./lookup";
import { selectedInterpreter } from "./python";

export async function surroundings(
  installed: string | undefined,
  log: vscode.LogOutputChannel,
): Promise<Surroundings> {
  const folders = vscode.workspace.workspaceFolders ?? [];
  const trusted = vscode.workspace.isTrusted;
  return {
    setting: vscode.workspace.getConfiguration("robbdd").get("server.path", ""),
    trusted,
    folders: folders.filter((folder) => folder.uri.scheme === "file").map((folder) => folder.uri.fsPath),
    python: trusted ? await selectedInterpreter(folders[0]?.uri, log) : undefined,
    searchPath: process.env["PATH"] ?? "",
    installed,
    home: homedir(),
    platform: process.platform,
    isExecutable,
  };
}

function isExecutable(path: string): boolean {
  try {
    accessSync(path, constants.X_OK);
    return statSync(path).isFile();
  } catch {
    return false;
  }
}
