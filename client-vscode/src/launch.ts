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

/** Python reads these before the server's first line: their relative folders may be those of the workspace. */
const READ_BY_PYTHON = new Set(["PYTHONPATH", "PYTHONINSPECT", "PYTHONSTARTUP"]);

/**
 * Return the variables to change in the server's environment: those of the settings, and those that Python must not see.
 * The server's agents search `ROBBDD_PYTHONPATH` last, so sourced ROS workspaces work.
 */
export function serverVariables(
  inherited: Readonly<Record<string, string | undefined>>,
  stated: Launch["env"],
): Record<string, string | undefined> {
  const changed: Record<string, string | undefined> = { ...stated };
  for (const [name, value] of Object.entries({ ...inherited, ...stated })) {
    // Windows ignores the case of names.
    const key = name.toUpperCase();
    if (READ_BY_PYTHON.has(key)) {
      changed[name] = undefined;
    }
    if (key === "PYTHONPATH" && value !== undefined && value !== "") {
      changed["ROBBDD_PYTHONPATH"] = value;
    }
  }
  return changed;
}
