// How the server is started: further arguments, and variables of its environment, from the user's settings.
import * as vscode from "vscode";
import { isRecord } from "./values";

export interface Launch {
  readonly args: readonly string[];
  /** Variables in addition to those of the editor. */
  readonly env: Readonly<Record<string, string>>;
}

/** Read the settings; entries of another type are ignored. An untrusted workspace cannot change them. */
export function launchSettings(): Launch {
  const settings = vscode.workspace.getConfiguration("robbdd");
  return launchOf(settings.get<unknown>("server.arguments"), settings.get<unknown>("server.environment"));
}

export function launchOf(args: unknown, env: unknown): Launch {
  const variables = isRecord(env) ? Object.entries(env) : [];
  return {
    args: Array.isArray(args) ? args.filter((one) => typeof one === "string") : [],
    env: Object.fromEntries(variables.filter((entry): entry is [string, string] => typeof entry[1] === "string")),
  };
}
